//! LM-63's tilt data in a file of their own, `TILT=lamp.tlt`: pasted in before the file is parsed, since
//! parsers read no files.

use super::text::decode;

/// The file that a `TILT=` line names; `None` for NONE, INCLUDE and files of other formats.
pub fn tilt_file(bytes: &[u8]) -> Option<String> {
    let text = decode(bytes.get(..bytes.len().min(64 << 10))?);
    let line = text.lines().find(|line| is_tilt(line))?;
    let name = line.split_once('=')?.1.trim();
    let keyword = ["NONE", "INCLUDE"].iter().any(|word| name.eq_ignore_ascii_case(word));
    (!name.is_empty() && !keyword).then(|| name.to_owned())
}

/// The file with `tilt` as its INCLUDE data. They are put before the number of lamps, in the same line, so
/// that no line changes its number.
pub fn with_tilt(bytes: &[u8], tilt: &[u8]) -> Vec<u8> {
    let (text, data) = (decode(bytes), decode(tilt));
    let numbers = data.split_whitespace().collect::<Vec<_>>().join(" ");
    let mut lines = text.lines();
    let mut pasted = String::new();
    for line in lines.by_ref().take_while(|line| !is_tilt(line)) {
        pasted.push_str(line);
        pasted.push('\n');
    }
    pasted.push_str("TILT=INCLUDE\n");
    pasted.push_str(&numbers);
    for line in lines {
        pasted.push(' ');
        pasted.push_str(line);
        pasted.push('\n');
    }
    pasted.into_bytes()
}

pub(super) fn is_tilt(line: &str) -> bool {
    let line = line.trim_start();
    line.get(..4).is_some_and(|word| word.eq_ignore_ascii_case("TILT")) && line.contains('=')
}

#[cfg(test)]
mod tests {
    use super::super::parse;
    use super::*;

    /// Catches: a keyword taken for a file, data pasted in the wrong place, line numbers that move.
    #[test]
    fn tilt_data_of_another_file_are_those_of_include() {
        let file = "IESNA:LM-63-1995\r\nTILT=lamp.tlt\r\n1 1000 1 3 1 1 2 0.1 0.1 0\r\n1 1 10\r\n0 45 90\r\n0\r\n100 x 0\r\n";
        assert_eq!(tilt_file(file.as_bytes()), Some("lamp.tlt".to_owned()));
        assert_eq!(tilt_file(file.replace("lamp.tlt", "NONE").as_bytes()), None);
        assert_eq!(tilt_file(b"Maker\n2\n0\n"), None);
        let pasted = with_tilt(file.as_bytes(), b"1\r\n3\r\n0 45 90\r\n0.5 0.8 0.7\r\n");
        assert_eq!(parse(&pasted, "a.ies").expect_err("an x").line, 7);
        let sound = with_tilt(file.replace('x', "40").as_bytes(), b"1 3 0 45 90 0.5 0.8 0.7");
        let lamp = parse(&sound, "a.ies").expect("sound");
        assert!((lamp.distribution.max_intensity().0 - 50.0).abs() < 1e-9);
        assert!(lamp.findings.iter().any(|finding| finding.code == "tilt" && finding.line == Some(2)));
    }
}
