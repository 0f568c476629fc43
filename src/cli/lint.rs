//! `clopen lint FILE.nc`: anyone's program.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result, anyhow, bail};
use clap::Args;

use super::ExitStatus;
use super::check::FormatArg;
use super::{input, output};
use crate::gcode::{Dialect, Finding, LintOptions, RULES, RuleInfo, RuleScope, lint};
use crate::units::{Length, nearest_name};

/// The arguments.
#[derive(Clone, Debug, Args)]
pub(super) struct LintArgs {
    /// The program; - is standard input
    #[arg(value_name = "FILE", required_unless_present = "rules")]
    file: Option<PathBuf>,
    /// The controller: grbl, grblhal, fluidnc, linuxcnc, mach3, mach4, marlin, smoothieware, grbl-laser, plotter,
    /// plotter-servo, portable (GRBL and LinuxCNC), or a dialect file (my-machine.toml). Our own rules about safe motion
    /// always apply [default: what a program written by clopen says in its header, else portable]
    #[arg(long, value_name = "NAME|FILE.toml")]
    dialect: Option<String>,
    /// Leave out what breaks this rule; may be given more than once
    #[arg(long, value_name = "RULE")]
    allow: Vec<String>,
    /// Print the table of rules instead: name, severity, controllers, reason, source
    #[arg(long, conflicts_with = "file")]
    rules: bool,
    /// z of the top of the stock [default: as the header of a program of clopen says, else 0]
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true)]
    stock_top: Option<Length>,
    /// How to print the findings
    #[arg(long, value_enum, default_value_t = FormatArg::Text)]
    format: FormatArg,
}

/// Runs the command: exit status 1 where anything is found that is not allowed.
///
/// # Errors
/// Where the file cannot be read, or is a drawing.
pub(super) fn run(args: &LintArgs) -> Result<ExitStatus> {
    let allowed = args.allow.iter().map(|name| rule_named(name)).collect::<Result<Vec<_>>>()?;
    let asked = args.dialect.as_deref().map(input::dialect).transpose()?;
    if args.rules {
        let mut dialects: Vec<&Dialect> = Dialect::built_in().iter().collect();
        if let Some(asked) = &asked {
            dialects = vec![asked];
        }
        output::print(&match args.format {
            FormatArg::Text => rules_text(&dialects),
            FormatArg::Json => serde_json::to_string_pretty(&rules_json(&dialects))? + "\n",
        })?;
        return Ok(ExitStatus::Done);
    }
    let file = args.file.as_deref().context("name a program, or add --rules")?;
    let text = input::read_text(file)?;
    if text.trim_start_matches('\u{feff}').trim_start().starts_with('<') {
        bail!("{}: this is a drawing and no program: name what `clopen mill` wrote", file.display());
    }
    let stock_top = input::stock_top(args.stock_top, &text)?;
    let of_header = Dialect::of_header(&text).unwrap_or(Dialect::portable());
    let dialect = asked.as_ref().unwrap_or(of_header);
    if let Some(name) = Dialect::name_in_header(&text).filter(|name| asked.is_none() && *name != of_header.name) {
        output::say(&format!(
            "{}: its dialect, {name}, is not built in: --dialect {name}.toml holds it against that; here it is {}\n",
            file.display(),
            dialect.name
        ));
    }
    let mut findings = lint(&text, &LintOptions { dialect, stock_top });
    findings.retain(|f| !allowed.contains(&f.rule.info()));
    print(&findings, file, dialect, args.format)?;
    Ok(if findings.is_empty() { ExitStatus::Done } else { ExitStatus::CheckFailed })
}

fn rule_named(name: &str) -> Result<&'static RuleInfo> {
    RuleInfo::named(name).ok_or_else(|| {
        let meant = nearest_name(name, RULES.iter().map(|r| r.name));
        let meant = meant.map_or(String::new(), |m| format!(" (do you mean {m}?)"));
        anyhow!("--allow: \"{name}\" is no rule{meant}: `clopen lint --rules` lists them")
    })
}

fn print(findings: &[Finding], file: &Path, dialect: &Dialect, format: FormatArg) -> Result<()> {
    match format {
        FormatArg::Json => output::print(&(serde_json::to_string_pretty(findings)? + "\n"))?,
        FormatArg::Text => {
            let lines = findings.iter().map(|f| {
                format!("{}:{}: {}: {} [{}; {}]\n", file.display(), f.line, f.severity, f.message, f.rule, f.source)
            });
            output::print(&lines.collect::<String>())?;
            if findings.is_empty() {
                output::say(&format!("{}: no findings for {}\n", file.display(), dialect.name));
            }
        }
    }
    Ok(())
}

/// The controllers that a rule is for.
fn controllers(rule: &RuleInfo, dialects: &[&Dialect]) -> String {
    let refusing = dialects.iter().filter_map(|d| Some((d, d.refuses.get(&rule.rule)?)));
    let refusing: Vec<String> = refusing.map(|(d, how)| format!("{} ({how})", d.name)).collect();
    match rule.scope {
        RuleScope::Refused if refusing.is_empty() => "none of these".to_owned(),
        RuleScope::Refused => refusing.join(", "),
        RuleScope::Data if refusing.is_empty() => "as its dialect says".to_owned(),
        RuleScope::Data => format!("as its dialect says; {}", refusing.join(", ")),
        RuleScope::Always if refusing.is_empty() => "all".to_owned(),
        RuleScope::Always => format!("all; {}", refusing.join(", ")),
    }
}

fn rules_text(dialects: &[&Dialect]) -> String {
    let width = RULES.iter().map(|r| r.name.len()).max().unwrap_or(0);
    RULES.iter().fold(String::new(), |mut text, rule| {
        // Infallible: writing to a string.
        let _ = writeln!(text, "{:width$}  {:7}  {}", rule.name, rule.severity.to_string(), rule.meaning);
        let _ = writeln!(text, "{:width$}  for: {}", "", controllers(rule, dialects));
        let _ = writeln!(text, "{:width$}  source: {}", "", rule.source);
        text
    })
}

fn rules_json(dialects: &[&Dialect]) -> Vec<serde_json::Value> {
    let refusing = |rule: &RuleInfo| -> serde_json::Map<String, serde_json::Value> {
        let all = dialects.iter().filter_map(|d| Some((d.name.clone(), d.refuses.get(&rule.rule)?.clone().into())));
        all.collect()
    };
    let row = |rule: &RuleInfo| {
        serde_json::json!({
            "rule": rule.name,
            "severity": rule.severity,
            "scope": rule.scope.to_string(),
            "refused_by": refusing(rule),
            "reason": rule.meaning,
            "source": rule.source,
        })
    };
    RULES.iter().map(row).collect()
}
