//! From the raw axis to the one that is asked for: places that are one become one node, branches into samples of curves go,
//! edges run from branch to branch or to an end.

use super::domain::Graph;
use super::{AxisEdge, AxisNode, MedialAxis, NodeKind};

/// An edge while the graph changes.
struct Path {
    ends: [usize; 2],
    /// All nodes, ends included.
    nodes: Vec<AxisNode>,
    is_there: bool,
}

struct Pruner {
    nodes: Vec<(AxisNode, NodeKind)>,
    paths: Vec<Path>,
    /// Paths at every node, a loop twice.
    at: Vec<Vec<usize>>,
    /// How far the disks that were pruned onto a node reach out of its own.
    spent: Vec<f64>,
    is_there: Vec<bool>,
}

/// The axis without branches that nobody needs: those to samples of smooth curves; those whose disks the one at their root
/// covers up to `tolerance`, if they do not end in a corner.
pub(super) fn prune(graph: Graph, tolerance: f64, tiny: f64) -> MedialAxis {
    let mut pruner = Pruner::new(graph, tiny);
    pruner.drop_samples();
    pruner.join_paths();
    while pruner.drop_covered(tolerance) {
        pruner.join_paths();
    }
    pruner.finish(tiny)
}

impl Pruner {
    /// Joins the nodes of edges that have no length.
    fn new(graph: Graph, tiny: f64) -> Pruner {
        let n = graph.nodes.len();
        let mut root: Vec<usize> = (0..n).collect();
        let find = |root: &mut Vec<usize>, mut k: usize| {
            while root[k] != k {
                root[k] = root[root[k]];
                k = root[k];
            }
            k
        };
        let is_short = |(a, b, inner): &(usize, usize, Vec<AxisNode>)| {
            let at = |k: usize| graph.nodes[k].0.point;
            (at(*a) - at(*b)).norm() <= tiny && inner.iter().all(|i| (i.point - at(*a)).norm() <= tiny)
        };
        for edge in graph.edges.iter().filter(|e| is_short(e)) {
            let (a, b) = (find(&mut root, edge.0), find(&mut root, edge.1));
            // Corners stay what they are.
            let (kept, lost) = if graph.nodes[b].1 == NodeKind::Inner { (a, b) } else { (b, a) };
            root[lost] = kept;
        }
        let ends: Vec<usize> = (0..n).map(|k| find(&mut root, k)).collect();
        let nodes = graph.nodes;
        let mut paths = Vec::new();
        for (a, b, inner) in graph.edges {
            let (from, to) = (ends[a], ends[b]);
            let length: f64 = (nodes[from].0.point - nodes[to].0.point).norm();
            if from == to
                && (inner.is_empty()
                    || length <= tiny && inner.iter().all(|i| (i.point - nodes[from].0.point).norm() <= tiny))
            {
                continue;
            }
            let all = [nodes[from].0].into_iter().chain(inner).chain([nodes[to].0]).collect();
            paths.push(Path { ends: [from, to], nodes: all, is_there: true });
        }
        let mut at = vec![vec![]; n];
        for (k, path) in paths.iter().enumerate() {
            path.ends.iter().for_each(|&e| at[e].push(k));
        }
        let is_there = (0..n).map(|k| ends[k] == k).collect();
        Pruner { nodes, paths, at, spent: vec![0.0; n], is_there }
    }

    fn remove(&mut self, path: usize) {
        self.paths[path].is_there = false;
        for end in self.paths[path].ends {
            self.at[end].retain(|&p| p != path);
        }
    }

    fn drop_samples(&mut self) {
        for k in 0..self.nodes.len() {
            if self.is_there[k] && self.nodes[k].1 == NodeKind::Sample {
                self.is_there[k] = false;
                if let [path] = self.at[k][..] {
                    self.remove(path);
                }
            }
        }
    }

    /// Makes one path of two where only two meet.
    fn join_paths(&mut self) {
        for k in 0..self.nodes.len() {
            let [a, b] = self.at[k][..] else { continue };
            // A loop stays at its node.
            if a == b {
                continue;
            }
            let (mut first, mut second) = (self.taken(a), self.taken(b));
            if first.ends[0] == k {
                first.reverse();
            }
            if second.ends[1] == k {
                second.reverse();
            }
            first.nodes.extend(second.nodes.into_iter().skip(1));
            let joined = Path { ends: [first.ends[0], second.ends[1]], ..first };
            for end in joined.ends {
                self.at[end].push(self.paths.len());
            }
            self.paths.push(joined);
            self.is_there[k] = false;
        }
    }

    fn taken(&mut self, path: usize) -> Path {
        self.remove(path);
        let p = &mut self.paths[path];
        Path { ends: p.ends, nodes: std::mem::take(&mut p.nodes), is_there: true }
    }

    /// Drops paths to ends that are no corners and add nothing; whether there was one.
    fn drop_covered(&mut self, tolerance: f64) -> bool {
        let mut dropped = false;
        for k in 0..self.nodes.len() {
            let (true, NodeKind::Inner, [path]) = (self.is_there[k], self.nodes[k].1, &self.at[k][..]) else {
                continue;
            };
            let path = *path;
            let Path { ends, nodes, .. } = &self.paths[path];
            let root = if ends[0] == k { ends[1] } else { ends[0] };
            if self.nodes[root].1 != NodeKind::Inner {
                continue;
            }
            let (disk, spent) = (self.nodes[root].0, self.spent[k]);
            let outreach = |n: &AxisNode| (n.point - disk.point).norm() + n.clearance - disk.clearance + spent;
            let most = nodes.iter().map(outreach).fold(0.0, f64::max);
            if most <= tolerance {
                self.remove(path);
                self.is_there[k] = false;
                self.spent[root] = self.spent[root].max(most);
                dropped = true;
            }
        }
        dropped
    }

    fn finish(self, tiny: f64) -> MedialAxis {
        let mut number = vec![usize::MAX; self.nodes.len()];
        let mut nodes = Vec::new();
        for (k, node) in self.nodes.iter().enumerate() {
            if self.is_there[k] {
                number[k] = nodes.len();
                nodes.push(node.0);
            }
        }
        let edges = self
            .paths
            .into_iter()
            .filter(|p| p.is_there)
            .map(|p| AxisEdge { ends: p.ends.map(|e| number[e]), nodes: straightened(p.nodes, tiny) });
        MedialAxis { edges: edges.collect(), nodes }
    }
}

/// Without the nodes that lie on the straight way between their neighbours.
fn straightened(nodes: Vec<AxisNode>, tiny: f64) -> Vec<AxisNode> {
    let mut out: Vec<AxisNode> = Vec::with_capacity(nodes.len());
    for (k, node) in nodes.iter().enumerate() {
        let is_needed = match (out.last(), nodes.get(k + 1)) {
            (Some(before), Some(after)) => node.distance_to_chord(before, after) > tiny,
            _ => true,
        };
        if is_needed {
            out.push(*node);
        }
    }
    out
}

impl Path {
    fn reverse(&mut self) {
        self.ends.reverse();
        self.nodes.reverse();
    }
}
