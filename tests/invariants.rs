//! The design's invariants that can be read off the sources: who reads and writes files, who knows
//! whom, where f32 may live. Every rule is shown to reject a planted violation.

use std::path::Path;

/// A source file: its path below src/ with `/`, and its lines without comments and unit tests.
struct Source {
    path: String,
    lines: Vec<(usize, String)>,
}

impl Source {
    fn new(path: &str, text: &str) -> Self {
        let mut lines = Vec::new();
        let mut all = text.lines().enumerate();
        while let Some((number, line)) = all.next() {
            if let Some(indent) = line.strip_suffix("#[cfg(test)]") {
                // Leaves out the item: to its semicolon, or to the brace below its first letter.
                let end = format!("{indent}}}");
                let mut first = true;
                for (_, line) in all.by_ref() {
                    if line == end || (first && line.ends_with(';')) {
                        break;
                    }
                    first = line.trim_start().starts_with("#[");
                }
                continue;
            }
            let code = line.split("//").next().unwrap_or_default();
            lines.push((number + 1, code.to_owned()));
        }
        Self { path: path.to_owned(), lines }
    }

    /// The module below the crate: `report` for report/page.rs, `norm` for norm.rs.
    fn module(&self) -> &str {
        self.path.split('/').next().unwrap_or_default().trim_end_matches(".rs")
    }

    fn is_in(&self, places: &[&str]) -> bool {
        places
            .iter()
            .any(|place| self.path == format!("{place}.rs") || self.path.starts_with(&format!("{place}/")))
    }

    /// Lines with one of the words.
    fn with(&self, words: &[&str]) -> Vec<String> {
        let hit = |line: &str| words.iter().any(|word| line.contains(word));
        let lines = self.lines.iter().filter(|(_, line)| hit(line));
        lines.map(|(number, line)| format!("{}:{number}: {}", self.path, line.trim())).collect()
    }

    /// Lines with one of the identifiers.
    fn with_words(&self, words: &[&str]) -> Vec<String> {
        let identifiers = |line: &str| -> bool {
            line.split(|c: char| !(c.is_alphanumeric() || c == '_')).any(|word| words.contains(&word))
        };
        let lines = self.lines.iter().filter(|(_, line)| identifiers(line));
        lines.map(|(number, line)| format!("{}:{number}: {}", self.path, line.trim())).collect()
    }

    /// Modules of the crate that are imported or named, with their line.
    fn imports(&self) -> Vec<(usize, String)> {
        let mut found = Vec::new();
        let text = self.lines.iter().map(|(_, line)| line.as_str()).collect::<Vec<_>>().join("\n");
        let prefixes: &[&str] = if self.path == "main.rs" || self.path == "args.rs" {
            &["crate::", "gershun::"]
        } else {
            &["crate::"]
        };
        for prefix in prefixes {
            for (at, _) in text.match_indices(prefix) {
                let number = self.lines[text[..at].matches('\n').count()].0;
                let rest = &text[at + prefix.len()..];
                let names: Vec<String> = match rest.strip_prefix('{') {
                    Some(list) => top_level(list),
                    None => vec![rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect()],
                };
                found.extend(names.into_iter().map(|name| (number, name)));
            }
        }
        found
    }
}

/// First words of a braced import list, `a::{b, c}, d` → a, d.
fn top_level(list: &str) -> Vec<String> {
    let (mut depth, mut names, mut word, mut start) = (1, Vec::new(), String::new(), true);
    for c in list.chars() {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            _ => {}
        }
        if depth == 0 || (depth == 1 && c == ',') {
            if !word.is_empty() {
                names.push(std::mem::take(&mut word));
            }
            start = true;
            if depth == 0 {
                return names;
            }
        } else if depth == 1 && start {
            if c.is_alphanumeric() || c == '_' {
                word.push(c);
            } else if !word.is_empty() {
                start = false;
            }
        }
    }
    names
}

fn sources() -> Vec<Source> {
    fn collect(folder: &Path, root: &Path, sources: &mut Vec<Source>) {
        for entry in std::fs::read_dir(folder).expect("a readable folder") {
            let path = entry.expect("a readable entry").path();
            let name = path.strip_prefix(root).expect("below src").to_string_lossy().replace('\\', "/");
            if path.is_dir() {
                collect(&path, root, sources);
            } else if path.extension().is_some_and(|kind| kind == "rs")
                && !name.ends_with("tests.rs")
                && name != "report/sample.rs"
            {
                sources.push(Source::new(&name, &std::fs::read_to_string(&path).expect("UTF-8")));
            }
        }
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut sources = Vec::new();
    collect(&root, &root, &mut sources);
    assert!(sources.len() > 80, "only {} files found", sources.len());
    sources
}

type Rule = fn(&Source) -> Vec<String>;

/// Runs a rule over all sources, and over a planted file that it must reject.
fn holds(rule: Rule, planted_path: &str, planted: &str) {
    let planted = Source::new(planted_path, planted);
    assert!(!rule(&planted).is_empty(), "the rule does not notice {planted_path}: it cannot fail");
    let violations: Vec<String> = sources().iter().flat_map(rule).collect();
    assert!(violations.is_empty(), "\n{}\n", violations.join("\n"));
}

const READS: &[&str] =
    &["fs::read", "File::open", "read_to_string(", ".metadata()", "OpenOptions", "read_dir", "canonicalize("];
const WRITES: &[&str] =
    &["fs::write", "File::create", "create_dir", "fs::rename", "fs::remove", "fs::copy", "OpenOptions"];

/// Invariant 1. `report/folder.rs` reads back its own manifest; the program reads a norm's file to
/// show it and its own result to print it.
#[test]
fn only_project_reads_files() {
    let rule: Rule = |source| {
        if source.is_in(&["project", "commands_check", "commands_norm", "report/folder"]) {
            Vec::new()
        } else {
            source.with(READS)
        }
    };
    holds(rule, "photometry/ies.rs", "fn f() {\n    let bytes = std::fs::read(path);\n}\n");
    holds(rule, "geometry/gltf/mod.rs", "use std::fs::File;\nlet file = File::open(path)?;\n");
}

/// Invariant 1. The program itself writes the example of `gershun new`.
#[test]
fn only_report_writes_files() {
    let rule: Rule =
        |source| if source.is_in(&["report", "main"]) { Vec::new() } else { source.with(WRITES) };
    holds(rule, "solve/mod.rs", "std::fs::write(\"cache\", bytes)?;\n");
    holds(rule, "project/read.rs", "fs::create_dir_all(&folder)?;\n");
}

fn names(source: &Source, forbidden: &[&str]) -> Vec<String> {
    let hits = source.imports().into_iter().filter(|(_, name)| forbidden.contains(&name.as_str()));
    hits.map(|(line, name)| format!("{}:{line}: names {name}", source.path)).collect()
}

/// Invariant 2.
#[test]
fn norm_and_measure_do_not_know_which_solver_ran() {
    let rule: Rule = |source| {
        if !source.is_in(&["norm", "measure", "judge"]) {
            return Vec::new();
        }
        let mut found = source.with(&["solve::answer", "solve::path", "solve::prepare", "solve::look"]);
        found.extend(source.with_words(&["Method", "Effort", "Prepared"]));
        if source.is_in(&["norm"]) {
            found.extend(names(source, &["solve", "measure", "scene", "project", "outcome"]));
        }
        found
    };
    holds(rule, "measure/area.rs", "use crate::solve::{Method, Part};\n");
    holds(rule, "norm/read.rs", "use crate::solve::Part;\n");
}

/// Invariant 2.
#[test]
fn solve_knows_no_norm_no_observer_and_no_report() {
    let rule: Rule = |source| {
        if !source.is_in(&["solve"]) {
            return Vec::new();
        }
        names(
            source,
            &["norm", "outcome", "report", "project", "plan", "measure", "judge", "assemble", "glare"],
        )
    };
    holds(
        rule,
        "solve/answer.rs",
        "use crate::{\n    emitters::Emitters,\n    project::{Room, World},\n};\n",
    );
    holds(rule, "solve/mod.rs", "let x = crate::norm::bundled();\n");
}

/// Invariant 3. Sobol numbers and the numbers of glTF and OpenEXR are f32 and become f64 where they are read.
#[test]
fn f32_and_obvhs_live_in_the_ray_tracer() {
    let rule: Rule = |source| {
        if source.is_in(&["geometry/trace"]) {
            return Vec::new();
        }
        let mut found = source.with(&["obvhs"]);
        if !source.is_in(&["rng", "geometry/gltf", "image/exr"]) {
            found.extend(source.with_words(&["f32", "Vec3", "Vec3A"]));
        }
        found
    };
    holds(rule, "solve/answer.rs", "let x = y as f32;\n");
    holds(rule, "rng.rs", "use obvhs::aabb::Aabb;\n");
}

/// The modules from top to bottom. Differs from the design's list where data types are read from
/// above: `project`'s structs lie below `plan`, `measure` and `outcome`; materials below geometry.
const ORDER: &[&str] = &[
    "main",
    "commands_check",
    "commands_body",
    "commands_glare",
    "commands_lamp",
    "commands_norm",
    "commands_view",
    "commands_solve",
    "commands_run",
    "args",
    "args_body",
    "args_glare",
    "args_lamp",
    "args_solve",
    "args_view",
    "args_run",
    "lib",
    "report",
    "biases",
    "lamp",
    "observe",
    "assemble",
    "judge",
    "measure",
    "solve",
    "plan",
    "outcome",
    "project",
    "field",
    "emitters",
    "norm",
    "scene",
    "luminaire",
    "glare",
    "photometry",
    "geometry",
    "material",
    "query",
    "grid",
    "quantity",
    "image",
    "estimate",
    "rng",
    "sphere",
    "units",
    "digest",
];

fn rank(module: &str) -> Option<usize> {
    ORDER.iter().position(|known| *known == module)
}

#[test]
fn modules_import_only_downwards() {
    let rule: Rule = |source| {
        let Some(own) = rank(source.module()) else {
            return vec![format!("{}: a new module has no place in the order", source.path)];
        };
        let upward = source
            .imports()
            .into_iter()
            .filter(|(_, name)| name != source.module() && rank(name).is_some_and(|other| other <= own));
        upward
            .map(|(line, name)| format!("{}:{line}: {} imports {name}", source.path, source.module()))
            .collect()
    };
    holds(rule, "geometry/mesh.rs", "use crate::scene::Scene;\n");
    holds(rule, "units.rs", "use glam::DVec3;\nuse crate::{sphere, grid::Grid};\n");
    holds(rule, "surprise.rs", "fn f() {}\n");
}

/// House rule 7 and invariant 9.
#[test]
fn nothing_unwraps_outside_tests() {
    let rule: Rule = |source| source.with(&[".unwrap()", "todo!(", "unimplemented!(", "dbg!("]);
    holds(rule, "plan.rs", "let x = list.first().unwrap();\n");
}

/// Invariant 5: an order that differs from run to run must not reach any output.
#[test]
fn nothing_iterates_in_random_order() {
    let rule: Rule =
        |source| source.with(&["HashMap", "HashSet", "RandomState", "thread_rng", "from_entropy"]);
    holds(rule, "assemble.rs", "use std::collections::HashMap;\n");
}

/// Invariant 5: clock, host, threads and place of the run stay out of what is written and computed.
/// `lib.rs` watches the clock to stop.
#[test]
fn no_clock_host_or_thread_count_reaches_a_result() {
    let rule: Rule = |source| {
        let mut found = source.with(&[
            "SystemTime",
            "hostname",
            "current_num_threads",
            "current_dir",
            "chrono",
            "CARGO_MANIFEST_DIR",
        ]);
        if source.is_in(&["commands_check"]) {
            // Colour in a terminal is a matter of the terminal.
            found.extend(source.with(&["Instant", "available_parallelism"]));
        } else if !source.is_in(&["lib"]) {
            found.extend(source.with(&["Instant", "env::var", "available_parallelism"]));
        }
        found
    };
    holds(rule, "report/page.rs", "let now = SystemTime::now();\n");
    holds(rule, "solve/mod.rs", "let started = Instant::now();\n");
}

/// House rule 7: only the program prints.
#[test]
fn only_the_program_prints() {
    let rule: Rule = |source| {
        if source.is_in(&["main"]) {
            Vec::new()
        } else {
            source.with(&["println!(", "eprintln!(", "print!("])
        }
    };
    holds(rule, "solve/mod.rs", "    eprintln!(\"block {k}\");\n");
}

/// House rule 13: `unsafe` only where SIMD needs it and where a file is mapped, each block with its reason.
#[test]
fn unsafe_stays_in_the_ray_tracer_and_says_why() {
    let allowed = ["geometry/trace", "project/photometric"];
    let rule: Rule = |source| {
        let allowed = ["geometry/trace", "project/photometric"];
        if source.is_in(&allowed) { Vec::new() } else { source.with(&["unsafe "]) }
    };
    holds(rule, "rng.rs", "let x = unsafe { *p };\n");
    for path in allowed {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("src").join(path).with_extension("rs");
        let text = std::fs::read_to_string(path).expect("a source file");
        assert_eq!(text.matches("unsafe {").count(), text.matches("// SAFETY:").count());
    }
}
