"use strict";
(() => {
  // Columns of a motion: its end in seconds, line, kind, x, y, z; of an arc also its centre and its sweep.
  const END = 0, LINE = 1, KIND = 2, X = 3, Y = 4, Z = 5, CX = 6, CY = 7, SWEEP = 8;
  const RAPID = 0, ARC = 2, WAIT = 3, JUMP = 4;
  const NAMES = ["rapid", "line", "arc", "waiting", "start"];
  // Steps of colour between the top of the stock and the deepest cut; motions stroked at once.
  const STEPS = 16, CHUNK = 400;
  const MARGIN = 16;
  // Seconds: just behind the end of a motion, in the next.
  const AFTER = 1e-6;
  // Millimetres: a line that is drawn, and not seen to be one.
  const DOT = 1e-3;

  function color(name) {
    return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  }

  function rgb(hex) {
    return [1, 3, 5].map((k) => parseInt(hex.slice(k, k + 2), 16));
  }

  // Colours from the top of the stock down.
  function ramp() {
    const stops = ["--d0", "--d1", "--d2", "--d3"].map((name) => rgb(color(name)));
    return Array.from({ length: STEPS + 1 }, (_, k) => {
      const t = k / STEPS * (stops.length - 1), i = Math.min(Math.floor(t), stops.length - 2);
      return "rgb(" + stops[i].map((a, c) => Math.round(a + (stops[i + 1][c] - a) * (t - i))).join(",") + ")";
    });
  }

  function clock(seconds) {
    const whole = Math.floor(seconds / 60);
    return whole + ":" + (seconds - 60 * whole).toFixed(1).padStart(4, "0");
  }

  function start(program, root) {
    const motions = program.motions, count = motions.length;
    const total = count ? motions[count - 1][END] : 0;
    const find = (name) => root.querySelector("." + name);
    const canvas = root.querySelector("canvas"), context = canvas.getContext("2d");
    const play = find("play"), slider = find("time"), speed = find("speed"), choice = find("program");
    const outlines = program.outlines.map(([remains, path]) => [remains, new Path2D(path)]);
    const ghost = document.createElement("canvas"), swath = document.createElement("canvas"), path = document.createElement("canvas");
    const layers = [ghost, swath, path];
    let time = 0, playing = false, before = 0, drawn = 0, colors = {}, view = null;
    slider.max = total;

    const from = (k) => motions[k > 0 ? k - 1 : 0];
    const begin = (k) => k > 0 ? motions[k - 1][END] : 0;

    // The first motion that ends after t.
    function motionAt(t) {
      let low = 0, high = count - 1;
      while (low < high) {
        const middle = (low + high) >> 1;
        if (motions[middle][END] > t) high = middle; else low = middle + 1;
      }
      return low;
    }

    // The last entry of a list that begins with or before motion k.
    function entryAt(list, k) {
      let low = 0, high = list.length;
      while (low < high) {
        const middle = (low + high) >> 1;
        if (list[middle][0] > k) high = middle; else low = middle + 1;
      }
      return Math.max(low - 1, 0);
    }

    function toolAt(k) {
      const change = program.changes[entryAt(program.changes, k)];
      return program.tools[change ? change[1] : 0] || { name: "", diameter: 0, tip: 0, widening: 0 };
    }

    // How wide a tool cuts at the top of the stock when its tip is at z: a cone less than its diameter.
    function widthAt(tool, z) {
      return Math.min(tool.diameter, tool.tip + tool.widening * Math.max(0, program.top - z));
    }

    // Where the tool is after the fraction f of a motion.
    function placeOf(k, f) {
      const a = from(k), b = motions[k];
      const z = a[Z] + (b[Z] - a[Z]) * f;
      if (b[KIND] === ARC) {
        const angle = Math.atan2(a[Y] - b[CY], a[X] - b[CX]) + b[SWEEP] * f;
        const radius = Math.hypot(a[X] - b[CX], a[Y] - b[CY]);
        return { x: b[CX] + radius * Math.cos(angle), y: b[CY] + radius * Math.sin(angle), z };
      }
      return { x: a[X] + (b[X] - a[X]) * f, y: a[Y] + (b[Y] - a[Y]) * f, z };
    }

    // How a motion is drawn: -1 not at all, 0 dashed, else by depth.
    function styleOf(k) {
      const kind = motions[k][KIND];
      if (kind === JUMP || kind === WAIT) return -1;
      if (kind === RAPID) return 0;
      const below = program.top - 0.5 * (from(k)[Z] + motions[k][Z]);
      const t = program.depth > 0 ? Math.min(Math.max(below / program.depth, 0), 1) : 0;
      return 1 + Math.round(t * STEPS);
    }

    const inStock = (k) => motions[k][KIND] !== RAPID && Math.min(from(k)[Z], motions[k][Z]) < program.top;

    function trace(c, k, f) {
      const a = from(k), b = motions[k];
      if (b[KIND] === ARC) {
        const angle = Math.atan2(a[Y] - b[CY], a[X] - b[CX]);
        c.arc(b[CX], b[CY], Math.hypot(a[X] - b[CX], a[Y] - b[CY]), angle, angle + b[SWEEP] * f, b[SWEEP] < 0);
      } else {
        const p = placeOf(k, f);
        // What goes straight down is a dot as wide as the line.
        c.lineTo(p.x === a[X] && p.y === a[Y] ? p.x + DOT : p.x, p.y);
      }
    }

    // Strokes the motions from `first` up to `end`, runs of one style together; the last by the fraction f.
    function stroke(c, first, end, f, prepare) {
      let k = first;
      while (k < end) {
        const style = prepare(k, true);
        const last = Math.min(end, k + CHUNK);
        if (style === null) { k += 1; continue; }
        c.beginPath();
        c.moveTo(from(k)[X], from(k)[Y]);
        let next = k;
        do { trace(c, next, next === end - 1 ? f : 1); next += 1; } while (next < last && prepare(next, true) === style);
        prepare(k);
        c.stroke();
        k = next;
      }
    }

    function prepared(c, faint) {
      return (k, only) => {
        const style = styleOf(k);
        if (style < 0) return null;
        if (!only) {
          c.setLineDash(style === 0 ? [4 / view.scale, 4 / view.scale] : []);
          c.lineWidth = (style === 0 ? 1 : faint ? 1 : 1.8) / view.scale;
          c.strokeStyle = style === 0 ? colors.rapid : faint ? colors.ghost : colors.ramp[style - 1];
        }
        return style;
      };
    }

    function sweeping(c) {
      return (k, only) => {
        if (!inStock(k) || styleOf(k) < 1) return null;
        const width = widthAt(toolAt(k), Math.min(from(k)[Z], motions[k][Z]));
        if (!only) { c.setLineDash([]); c.lineWidth = width; c.strokeStyle = colors.swath; }
        return width;
      };
    }

    function millimetres(c) {
      c.setTransform(view.scale * view.ratio, 0, 0, -view.scale * view.ratio, view.x * view.ratio, view.y * view.ratio);
      c.lineCap = c.lineJoin = "round";
    }

    function clear(layer) {
      const c = layer.getContext("2d");
      c.setTransform(1, 0, 0, 1, 0, 0);
      c.clearRect(0, 0, layer.width, layer.height);
      millimetres(c);
      return c;
    }

    function resize() {
      const [left, low, right, high] = program.box;
      const width = Math.max(canvas.clientWidth, 80), ratio = window.devicePixelRatio || 1;
      const wide = Math.max(right - left, 1e-6), tall = Math.max(high - low, 1e-6);
      const most = Math.max(240, 0.75 * window.innerHeight);
      const scale = Math.min((width - 2 * MARGIN) / wide, (most - 2 * MARGIN) / tall);
      const height = Math.max(120, Math.round(tall * scale + 2 * MARGIN));
      view = { scale, ratio, x: 0.5 * width - 0.5 * (left + right) * scale, y: 0.5 * height + 0.5 * (low + high) * scale };
      canvas.style.height = height + "px";
      for (const c of [canvas, ...layers]) { c.width = Math.round(width * ratio); c.height = Math.round(height * ratio); }
      for (const name of ["part", "outline", "swath", "ghost", "rapid", "tool", "mark", "ink", "back"]) colors[name] = color("--" + name);
      colors.ramp = ramp();
      const c = clear(ghost);
      c.fillStyle = colors.part;
      for (const [remains, outline] of outlines) if (remains) c.fill(outline, "evenodd");
      stroke(c, 0, count, 1, prepared(c, true));
      clear(swath);
      clear(path);
      drawn = 0;
      draw();
    }

    function draw() {
      if (!count) return;
      const k = motionAt(time);
      const span = motions[k][END] - begin(k);
      const f = span > 0 ? Math.min(Math.max((time - begin(k)) / span, 0), 1) : 1;
      if (k < drawn) { clear(swath); clear(path); drawn = 0; }
      if (k > drawn) {
        const s = swath.getContext("2d"), p = path.getContext("2d");
        stroke(s, drawn, k, 1, sweeping(s));
        stroke(p, drawn, k, 1, prepared(p, false));
        drawn = k;
      }
      const c = context;
      c.setTransform(1, 0, 0, 1, 0, 0);
      c.clearRect(0, 0, canvas.width, canvas.height);
      c.drawImage(ghost, 0, 0);
      c.globalAlpha = 0.75;
      c.drawImage(swath, 0, 0);
      millimetres(c);
      stroke(c, k, k + 1, f, sweeping(c));
      c.globalAlpha = 1;
      c.setLineDash([]);
      c.lineWidth = 1.2 / view.scale;
      c.strokeStyle = colors.outline;
      for (const [, outline] of outlines) c.stroke(outline);
      c.setTransform(1, 0, 0, 1, 0, 0);
      c.drawImage(path, 0, 0);
      millimetres(c);
      stroke(c, k, k + 1, f, prepared(c, false));
      const at = placeOf(k, f), tool = toolAt(k);
      c.setLineDash([]);
      c.beginPath();
      c.arc(at.x, at.y, Math.max(0.5 * tool.diameter, 3 / view.scale), 0, 2 * Math.PI);
      c.globalAlpha = 0.25;
      c.fillStyle = colors.tool;
      c.fill();
      c.globalAlpha = 1;
      c.strokeStyle = colors.tool;
      c.lineWidth = 1.6 / view.scale;
      c.stroke();
      // Marks stand upright: in pixels.
      c.setTransform(view.ratio, 0, 0, view.ratio, 0, 0);
      c.strokeStyle = c.fillStyle = colors.mark;
      c.lineWidth = 1.4;
      c.font = "600 12px system-ui, sans-serif";
      for (const [number, x, y] of program.marks) {
        const px = view.x + x * view.scale, py = view.y - y * view.scale;
        c.beginPath();
        c.arc(px, py, 6, 0, 2 * Math.PI);
        c.stroke();
        c.fillText(number, px + 8, py - 5);
      }
      slider.value = time;
      slider.setAttribute("aria-valuetext", clock(time) + " of " + clock(total));
      find("clock").textContent = clock(time) + " of " + clock(total);
      const running = entryAt(program.programs, k);
      if (choice) choice.value = running;
      find("line").textContent = "line " + motions[k][LINE] + " of " + program.programs[running][1];
      find("z").textContent = "z " + at.z.toFixed(3) + " mm";
      find("what").textContent = NAMES[motions[k][KIND]] + (tool.name ? ", " + tool.name : "");
    }

    function tick(now) {
      if (!playing) return;
      time = Math.min(total, time + (now - before) / 1000 * Number(speed.value));
      before = now;
      if (time >= total) set(false);
      draw();
      if (playing) requestAnimationFrame(tick);
    }

    function set(on) {
      playing = on;
      play.textContent = on ? "Pause" : "Play";
      if (!on) return;
      if (time >= total) time = 0;
      before = performance.now();
      requestAnimationFrame(tick);
    }

    // To the end of the next motion, or of the one before.
    function step(way) {
      set(false);
      const k = motionAt(time);
      if (way > 0) time = motions[k][END];
      else time = time > begin(k) ? begin(k) : begin(Math.max(motionAt(begin(k) - 1e-9), 0));
      time = Math.min(Math.max(time, 0), total);
      draw();
    }

    play.addEventListener("click", () => set(!playing));
    find("back").addEventListener("click", () => step(-1));
    find("next").addEventListener("click", () => step(1));
    slider.addEventListener("input", () => { set(false); time = Number(slider.value); draw(); });
    if (choice) choice.addEventListener("change", () => {
      set(false);
      time = begin(program.programs[Number(choice.value)][0]) + AFTER;
      draw();
    });
    canvas.addEventListener("keydown", (event) => {
      if (event.key === " ") set(!playing);
      else if (event.key === "ArrowRight") step(1);
      else if (event.key === "ArrowLeft") step(-1);
      else return;
      event.preventDefault();
    });
    let width = 0;
    new ResizeObserver(() => {
      if (canvas.clientWidth !== width) { width = canvas.clientWidth; resize(); }
    }).observe(canvas);
    window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", resize);
    width = canvas.clientWidth;
    resize();
    return { go: (share) => { time = share * total; draw(); } };
  }

  const player = start(JSON.parse(document.getElementById("work").textContent), document.getElementById("player"));
  // A link can say where to begin: #50 is half of the time.
  const share = parseFloat(location.hash.slice(1)) / 100;
  if (share >= 0 && share <= 1) player.go(share);
  requestAnimationFrame(() => { document.body.dataset.ready = "yes"; });
})();
