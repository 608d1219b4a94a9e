//! The outer shell of glTF: the chunks of a .glb, and the bytes behind a URI. Written here because
//! lengths in a damaged file must never be trusted, not even to be larger than the header.

use super::GltfError;

/// JSON text and, for a .glb, its binary chunk.
pub(super) fn split(document: &[u8]) -> Result<(&[u8], Option<&[u8]>), GltfError> {
    if !document.starts_with(b"glTF") {
        return Ok((document, None));
    }
    let word = |at: usize| -> Option<usize> {
        let bytes = document.get(at..at.checked_add(4)?)?;
        Some(u32::from_le_bytes(bytes.try_into().ok()?) as usize)
    };
    let broken = |what: &str| GltfError::Container(what.to_owned());
    let version = word(4).ok_or_else(|| broken("the 12-byte header is cut off"))?;
    if version != 2 {
        return Err(broken(&format!("version {version} is not supported, only 2")));
    }
    let length = word(8).ok_or_else(|| broken("the 12-byte header is cut off"))?;
    if length > document.len() {
        return Err(broken(&format!("the header announces {length} bytes, the file has {}", document.len())));
    }
    let (mut json, mut bin) = (None, None);
    let mut at = 12;
    while at < length {
        let (Some(size), Some(kind)) = (word(at), document.get(at + 4..at + 8)) else {
            return Err(broken(&format!("the chunk header at byte {at} is cut off")));
        };
        let end = at + 8 + size;
        if end > length {
            return Err(broken(&format!(
                "the chunk at byte {at} needs {size} bytes, {} are left",
                length.saturating_sub(at + 8)
            )));
        }
        let body = &document[at + 8..end];
        match kind {
            b"JSON" if json.is_some() => return Err(broken("there are two JSON chunks")),
            b"JSON" => json = Some(body),
            _ if json.is_none() => return Err(broken("the first chunk is not JSON")),
            b"BIN\0" if bin.is_some() => return Err(broken("there are two BIN chunks")),
            b"BIN\0" => bin = Some(body),
            _ => {}
        }
        // Chunks are padded to four bytes; a writer that forgot the padding of the last one is forgiven.
        at = end.next_multiple_of(4);
    }
    let json = json.ok_or_else(|| broken("there is no JSON chunk"))?;
    Ok((json, bin))
}

/// Bytes of a `data:` URI, or a path (percent-decoded) for the caller to read.
pub(super) enum Source {
    /// The bytes themselves.
    Inline(Vec<u8>),
    /// A relative path.
    Path(String),
}

/// Splits a URI into inline bytes or a relative path.
pub(super) fn source(uri: &str) -> Result<Source, String> {
    if let Some(rest) = uri.strip_prefix("data:") {
        let (head, body) = rest.split_once(',').ok_or("a data: URI without a comma".to_owned())?;
        return if head.ends_with(";base64") {
            base64(body.as_bytes()).map(Source::Inline)
        } else {
            percent_decode(body).map(Source::Inline)
        };
    }
    if uri.contains("://") {
        return Err("only relative and data: URIs are read".to_owned());
    }
    let path = String::from_utf8(percent_decode(uri)?)
        .map_err(|_| "the percent-decoded URI is not UTF-8".to_owned())?;
    if path.contains('\0') {
        return Err("a zero byte in the URI".to_owned());
    }
    Ok(Source::Path(path))
}

fn percent_decode(text: &str) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let [first, tail @ ..] = rest {
        rest = tail;
        if *first != b'%' {
            bytes.push(*first);
            continue;
        }
        let digit = |at: usize| {
            tail.get(at)
                .and_then(|&c| char::from(c).to_digit(16))
                .ok_or("\"%\" without two hexadecimal digits".to_owned())
        };
        bytes.push((16 * digit(0)? + digit(1)?) as u8);
        rest = &tail[2..];
    }
    Ok(bytes)
}

fn base64(text: &[u8]) -> Result<Vec<u8>, String> {
    let padding = text.iter().rev().take_while(|&&c| c == b'=').count();
    let digits = &text[..text.len() - padding];
    if padding > 2 || digits.len() % 4 == 1 {
        return Err("base64 data of a wrong length".to_owned());
    }
    let mut bytes = Vec::with_capacity(digits.len() / 4 * 3 + 3);
    let (mut word, mut bits) = (0u32, 0);
    for &c in digits {
        let value = match c {
            b'A'..=b'Z' => c - b'A',
            b'a'..=b'z' => c - b'a' + 26,
            b'0'..=b'9' => c - b'0' + 52,
            b'+' | b'-' => 62,
            b'/' | b'_' => 63,
            _ => return Err(format!("{:?} is no base64 digit", char::from(c))),
        };
        word = (word << 6) | u32::from(value);
        bits += 6;
        if bits >= 8 {
            bits -= 8;
            bytes.push((word >> bits) as u8);
            word &= (1 << bits) - 1;
        }
    }
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_and_percent_are_decoded_and_garbage_is_refused() {
        assert_eq!(base64(b"Z2Vyc2h1bg==").unwrap(), b"gershun");
        assert_eq!(base64(b"").unwrap(), b"");
        assert!(base64(b"Z2V!").is_err());
        assert!(base64(b"Z2VyZ").is_err());
        assert_eq!(percent_decode("a%20b").unwrap(), b"a b");
        for text in ["%", "%2", "%zz", "a%g1"] {
            assert!(percent_decode(text).is_err(), "{text}");
        }
    }

    #[test]
    fn a_header_shorter_than_itself_is_refused() {
        let mut file = b"glTF".to_vec();
        file.extend(2u32.to_le_bytes());
        file.extend(0u32.to_le_bytes());
        assert!(split(&file).is_err());
        assert!(split(b"glTF\x02").is_err());
    }
}
