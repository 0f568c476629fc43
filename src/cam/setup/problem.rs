//! What is wrong with a job file, by line.

/// One thing that is wrong with a job file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SetupProblem {
    /// The line, counted from 1; 0 where it is about the whole.
    pub line: usize,
    /// What is wrong and what to try.
    pub message: String,
}

/// All that is wrong with a job file; never empty.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub struct InvalidSetup {
    /// The problems by line.
    pub problems: Vec<SetupProblem>,
}

impl std::fmt::Display for InvalidSetup {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        for (k, problem) in self.problems.iter().enumerate() {
            let separator = if k == 0 { "" } else { "\n" };
            match problem.line {
                0 => write!(f, "{separator}{}", problem.message)?,
                line => write!(f, "{separator}line {line}: {}", problem.message)?,
            }
        }
        Ok(())
    }
}
