//! Bytes → text. Photometric files have no declared encoding: only descriptions contain anything
//! but ASCII, so decoding never fails; at worst a name looks odd.

/// UTF-8, UTF-16 with a byte order mark, CP1251 or Latin-1, with line ends made `\n`.
pub(super) fn decode(bytes: &[u8]) -> String {
    let text = match bytes {
        [0xEF, 0xBB, 0xBF, rest @ ..] => String::from_utf8_lossy(rest).into_owned(),
        [0xFF, 0xFE, rest @ ..] => from_utf16(rest, u16::from_le_bytes),
        [0xFE, 0xFF, rest @ ..] => from_utf16(rest, u16::from_be_bytes),
        _ => match std::str::from_utf8(bytes) {
            Ok(text) => text.to_owned(),
            Err(_) if is_cyrillic(bytes) => bytes.iter().map(|byte| cp1251(*byte)).collect(),
            Err(_) => bytes.iter().map(|byte| char::from(*byte)).collect(),
        },
    };
    // U+001A ends text files of DOS programs.
    text.replace("\r\n", "\n").replace('\r', "\n").replace('\u{1a}', " ")
}

fn from_utf16(bytes: &[u8], unit: fn([u8; 2]) -> u16) -> String {
    let units = bytes.chunks_exact(2).map(|pair| unit([pair[0], pair[1]]));
    char::decode_utf16(units).map(|unit| unit.unwrap_or(char::REPLACEMENT_CHARACTER)).collect()
}

/// Cyrillic words are runs of letters above 0xC0; in Latin-1 such letters stand alone.
fn is_cyrillic(bytes: &[u8]) -> bool {
    let high = bytes.iter().filter(|byte| **byte >= 0x80).count();
    let in_runs = bytes.windows(2).filter(|pair| pair[0] >= 0xC0 && pair[1] >= 0xC0).count();
    2 * in_runs > high
}

fn cp1251(byte: u8) -> char {
    match byte {
        0xC0..=0xFF => char::from_u32(0x0410 + u32::from(byte) - 0xC0).unwrap_or('?'),
        0xA8 => 'Ё',
        0xB8 => 'ё',
        0xB9 => '№',
        _ => char::from(byte),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches: Cyrillic names printed as Latin-1, umlauts printed as Cyrillic, lost line ends.
    #[test]
    fn encodings_are_told_apart() {
        assert_eq!(decode(b"\xD1\xE2\xE5\xF2\xE8\xEB\xFC\xED\xE8\xEA \xB9 5\r\n"), "Светильник № 5\n");
        assert_eq!(decode(b"Str\xE4hler f\xFCr B\xFCro\rA"), "Strähler für Büro\nA");
        assert_eq!(decode("\u{feff}Büro".as_bytes()), "Büro");
        assert_eq!(decode(b"\xFF\xFEA\0\n\0B\0"), "A\nB");
    }
}
