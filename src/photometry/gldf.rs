//! GLDF containers: a ZIP archive whose product.xml names the photometric files in `ldc/` and the
//! emitters that use them. Nothing is unpacked beyond fixed limits, whatever the archive claims.

use std::io::{Cursor, Read};

use roxmltree::{Document, Node};
use zip::ZipArchive;

use super::{Fault, text};

/// Largest product.xml and largest photometric file.
const PART_BYTES: u64 = 16 << 20;
/// More entries or photometries than any product has.
const MAX_ENTRIES: usize = 10_000;
const MAX_PARTS: usize = 256;

const DAMAGED: &str = "the container is damaged: get it from its manufacturer again";

/// One photometric file of a container.
pub(super) struct Part {
    /// Path in the container, `ldc/a.ldt`.
    pub(super) name: String,
    pub(super) bytes: Vec<u8>,
    /// Emitters that use it.
    pub(super) emitters: Vec<String>,
}

type Archive<'a> = ZipArchive<Cursor<&'a [u8]>>;

/// The photometric files that product.xml refers to, in its order.
pub(super) fn parts(bytes: &[u8]) -> Result<Vec<Part>, Fault> {
    let fault = |message: String| Fault::new(1, message, DAMAGED);
    let mut archive =
        Archive::new(Cursor::new(bytes)).map_err(|error| fault(format!("not a GLDF container: {error}")))?;
    if archive.len() > MAX_ENTRIES {
        return Err(fault(format!("{} entries, more than {MAX_ENTRIES}", archive.len())));
    }
    let product = read(&mut archive, "product.xml")?;
    let text = text::decode(&product);
    let document = Document::parse(&text).map_err(|error| fault(format!("product.xml: {error}")))?;
    let references = references(&document);
    if references.is_empty() {
        let hint = "only photometric files (ldc/eulumdat, ldc/ies) are read; get a container with photometry";
        return Err(Fault::new(1, "the container names no photometry", hint));
    }
    if references.len() > MAX_PARTS {
        return Err(fault(format!("{} photometries, more than {MAX_PARTS}", references.len())));
    }
    let mut parts: Vec<Part> = Vec::new();
    for reference in references {
        let name = format!("ldc/{}", reference.file);
        if let Some(known) = parts.iter_mut().find(|part| part.name == name) {
            known.emitters.extend(reference.emitters);
            continue;
        }
        let bytes = read(&mut archive, &name)?;
        parts.push(Part { name, bytes, emitters: reference.emitters });
    }
    Ok(parts)
}

struct Reference {
    file: String,
    emitters: Vec<String>,
}

/// Photometry → its file of type `ldc/…`, with the emitters that name it.
fn references(document: &Document) -> Vec<Reference> {
    let named = |name: &'static str| document.descendants().filter(move |node| node.has_tag_name(name));
    let is = |node: &Node, attribute: &str, value: &str| node.attribute(attribute) == Some(value);
    let file_of = |photometry: Node| -> Option<String> {
        let id = photometry
            .descendants()
            .find(|node| node.has_tag_name("PhotometryFileReference"))?
            .attribute("fileId")?;
        let file = named("File").find(|file| is(file, "id", id))?;
        let photometric = file.attribute("contentType").is_some_and(|kind| kind.starts_with("ldc/"));
        let name = file.text().map(str::trim).filter(|name| !name.is_empty())?;
        (photometric && !is(&file, "type", "url")).then(|| name.to_owned())
    };
    let emitters_of = |photometry: Node| -> Vec<String> {
        let Some(id) = photometry.attribute("id") else {
            return Vec::new();
        };
        let uses = |emitter: &Node| {
            emitter
                .descendants()
                .any(|node| node.has_tag_name("PhotometryReference") && is(&node, "photometryId", id))
        };
        let name = |emitter: Node| emitter.attribute("id").map(str::to_owned);
        named("Emitter").filter(uses).filter_map(name).collect()
    };
    named("Photometry")
        .filter_map(|photometry| {
            Some(Reference { file: file_of(photometry)?, emitters: emitters_of(photometry) })
        })
        .collect()
}

/// The bytes of an entry; names differ in case and encoding between product.xml and the archive.
fn read(archive: &mut Archive, name: &str) -> Result<Vec<u8>, Fault> {
    let fault = |message: String| Fault::new(1, message, DAMAGED);
    let folder = name.split_once('/').map(|(folder, _)| format!("{folder}/"));
    let same = |entry: &str| entry.to_lowercase() == name.to_lowercase();
    let index = archive.index_for_name(name).or_else(|| {
        let names: Vec<String> = archive.file_names().flatten().map(|entry| entry.to_string()).collect();
        let exact = names.iter().find(|entry| same(entry));
        let mut in_folder = names.iter().filter(|entry| {
            folder
                .as_ref()
                .is_some_and(|folder| entry.len() > folder.len() && entry.starts_with(folder.as_str()))
        });
        // A lone file whose name was garbled by its encoding.
        let lone = in_folder.next().filter(|_| in_folder.next().is_none());
        exact.or(lone).and_then(|entry| archive.index_for_name(entry))
    });
    let Some(index) = index else {
        return Err(fault(format!("the container lacks '{name}'")));
    };
    let entry = archive.by_index(index).map_err(|error| fault(format!("'{name}': {error}")))?;
    let mut bytes = Vec::new();
    entry
        .take(PART_BYTES + 1)
        .read_to_end(&mut bytes)
        .map_err(|error| fault(format!("'{name}' cannot be unpacked: {error}")))?;
    if bytes.len() as u64 > PART_BYTES {
        return Err(fault(format!("'{name}' is larger than {} MiB", PART_BYTES >> 20)));
    }
    Ok(bytes)
}

#[cfg(test)]
pub(super) mod tests {
    use std::io::Write;

    use super::*;

    /// A container with the given `ldc/` files, all stored uncompressed.
    pub(in super::super) fn container(files: &[(&str, &str)]) -> Vec<u8> {
        let mut writer = zip::ZipWriter::new(Cursor::new(Vec::new()));
        let options = zip::write::SimpleFileOptions::default();
        let list = |one: &dyn Fn(&str) -> String| files.iter().map(|(name, _)| one(name)).collect::<String>();
        let product = format!(
            "<Root><GeneralDefinitions><Files>{}</Files><Photometries>{}</Photometries><Emitters>{}</Emitters>\
             </GeneralDefinitions></Root>",
            list(&|name| format!("<File id='f{name}' contentType='ldc/eulumdat'>{name}</File>")),
            list(&|name| format!(
                "<Photometry id='p{name}'><PhotometryFileReference fileId='f{name}'/></Photometry>"
            )),
            list(&|name| format!(
                "<Emitter id='e{name}'><FixedLightEmitter><PhotometryReference photometryId='p{name}'/>\
                 </FixedLightEmitter></Emitter>"
            )),
        );
        let all = files.iter().map(|(name, text)| (format!("ldc/{name}"), *text));
        for (name, text) in all.chain([("product.xml".to_owned(), product.as_str())]) {
            writer.start_file(name, options).expect("entry");
            writer.write_all(text.as_bytes()).expect("written");
        }
        writer.finish().expect("archive").into_inner()
    }

    /// Catches: an emitter lost, an entry of other case not found, a bomb unpacked.
    #[test]
    fn parts_are_found_by_reference() {
        let bytes = container(&[("a.ldt", "one"), ("b.ldt", "two")]);
        let found = parts(&bytes).unwrap_or_else(|fault| panic!("{}", fault.message));
        assert_eq!(found.len(), 2);
        assert_eq!((found[1].name.as_str(), &found[1].bytes[..]), ("ldc/b.ldt", &b"two"[..]));
        assert_eq!(found[1].emitters, ["eb.ldt"]);
        let huge = "0".repeat(PART_BYTES as usize + 1);
        let error = parts(&container(&[("a.ldt", &huge)])).err().expect("too large");
        assert!(error.message.contains("larger than 16 MiB"), "{}", error.message);
        assert!(parts(&container(&[])).is_err());
    }

    /// Catches: a panic on a damaged archive.
    #[test]
    fn damaged_containers_never_panic() {
        let whole = container(&[("a.ldt", "one")]);
        for at in 0..whole.len() {
            let mut flipped = whole.clone();
            flipped[at] ^= 1 << (at % 8);
            let _ = (parts(&flipped), parts(&whole[..at]));
        }
    }
}
