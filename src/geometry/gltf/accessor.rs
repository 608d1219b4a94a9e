//! Numbers out of buffers. Every offset is checked against the bytes that are really there before
//! anything is allocated, because all of them come from the file.

use std::borrow::Cow;

use gltf::json::accessor::{Accessor, ComponentType, Type};
use gltf::json::validation::Checked;
use gltf::json::{Index, Root};

use super::{DVec3, GltfError, container};

/// Largest count of an accessor that has no bytes behind it (sparse over zeros).
const MAX_IMPLICIT: usize = 10_000_000;

/// The buffers of a document, each loaded when first used.
pub(super) struct Buffers<'a> {
    root: &'a Root,
    bin: Option<&'a [u8]>,
    read: &'a mut dyn FnMut(&str) -> Result<Vec<u8>, String>,
    loaded: Vec<Option<Cow<'a, [u8]>>>,
}

/// One element type: how many bytes, and where the next one is.
struct Layout {
    start: usize,
    stride: usize,
    buffer: usize,
}

impl<'a> Buffers<'a> {
    /// Nothing is read yet.
    pub(super) fn new(
        root: &'a Root,
        bin: Option<&'a [u8]>,
        read: &'a mut dyn FnMut(&str) -> Result<Vec<u8>, String>,
    ) -> Self {
        let loaded = vec![None; root.buffers.len()];
        Self { root, bin, read, loaded }
    }

    /// Positions in the file's own axes, as written.
    pub(super) fn positions(&mut self, index: Index<Accessor>, user: &str) -> Result<Vec<DVec3>, GltfError> {
        let (name, accessor) = self.accessor(index, user)?;
        let is_vec3 = matches!(accessor.type_, Checked::Valid(Type::Vec3));
        let is_f32 = component(accessor) == Some(ComponentType::F32);
        if !is_vec3 || !is_f32 {
            return Err(GltfError::Accessor {
                name,
                what: "positions must be VEC3 of 32-bit floats".to_owned(),
            });
        }
        let mut points = self.elements(accessor, &name, 12, &|bytes| vector(bytes))?;
        if let Some(sparse) = &accessor.sparse {
            let count = count_of(sparse.count.0, &name)?;
            if count > points.len() {
                return Err(GltfError::Accessor {
                    name,
                    what: format!("{count} sparse values for {} elements", points.len()),
                });
            }
            let Checked::Valid(kind) = &sparse.indices.component_type else {
                return Err(bad_type(&name));
            };
            let size = width(kind.0);
            let offset = count_of(sparse.indices.byte_offset.0, &name)?;
            let view = sparse.indices.buffer_view.value();
            let layout = self.layout(view, offset, count, size, None, &name)?;
            let at = self.collect(&layout, count, size, &unsigned);
            let offset = count_of(sparse.values.byte_offset.0, &name)?;
            let view = sparse.values.buffer_view.value();
            let layout = self.layout(view, offset, count, 12, None, &name)?;
            let values = self.collect(&layout, count, 12, &vector);
            for (at, value) in at.into_iter().zip(values) {
                let point = points.get_mut(at as usize).ok_or_else(|| GltfError::Accessor {
                    name: name.clone(),
                    what: format!("sparse index {at} is out of range"),
                })?;
                *point = value;
            }
        }
        Ok(points)
    }

    /// Vertex indices.
    pub(super) fn indices(&mut self, index: Index<Accessor>, user: &str) -> Result<Vec<u32>, GltfError> {
        let (name, accessor) = self.accessor(index, user)?;
        let size = match component(accessor) {
            Some(kind @ (ComponentType::U8 | ComponentType::U16 | ComponentType::U32))
                if matches!(accessor.type_, Checked::Valid(Type::Scalar)) =>
            {
                width(kind)
            }
            _ => {
                return Err(GltfError::Accessor {
                    name,
                    what: "indices must be unsigned SCALARs".to_owned(),
                });
            }
        };
        if accessor.sparse.is_some() {
            return Err(GltfError::Accessor { name, what: "sparse indices are not supported".to_owned() });
        }
        self.elements(accessor, &name, size, &unsigned)
    }

    fn accessor(&self, index: Index<Accessor>, user: &str) -> Result<(String, &'a Accessor), GltfError> {
        let accessor = self.root.accessors.get(index.value()).ok_or_else(|| GltfError::Reference {
            from: user.to_owned(),
            to: format!("accessor {}", index.value()),
        })?;
        let name = match &accessor.name {
            Some(name) => format!("accessor {} \"{name}\" of {user}", index.value()),
            None => format!("accessor {} of {user}", index.value()),
        };
        Ok((name, accessor))
    }

    fn elements<T: Clone + Default>(
        &mut self,
        accessor: &Accessor,
        name: &str,
        size: usize,
        read: &dyn Fn(&[u8]) -> T,
    ) -> Result<Vec<T>, GltfError> {
        let count = count_of(accessor.count.0, name)?;
        let Some(view) = accessor.buffer_view else {
            if accessor.sparse.is_none() || count > MAX_IMPLICIT {
                return Err(GltfError::Accessor {
                    name: name.to_owned(),
                    what: format!("{count} elements without a buffer view"),
                });
            }
            return Ok(vec![T::default(); count]);
        };
        let offset = count_of(accessor.byte_offset.map_or(0, |offset| offset.0), name)?;
        let stride = self
            .root
            .buffer_views
            .get(view.value())
            .and_then(|view| view.byte_stride.as_ref())
            .map(|stride| stride.0);
        let layout = self.layout(view.value(), offset, count, size, stride, name)?;
        Ok(self.collect(&layout, count, size, read))
    }

    /// Checks that `count` elements lie within the view, the view within its buffer, and the buffer in its bytes.
    fn layout(
        &mut self,
        view_index: usize,
        offset: usize,
        count: usize,
        size: usize,
        stride: Option<usize>,
        name: &str,
    ) -> Result<Layout, GltfError> {
        let fault = |what: String| GltfError::Accessor { name: name.to_owned(), what };
        let view = self.root.buffer_views.get(view_index).ok_or_else(|| GltfError::Reference {
            from: name.to_owned(),
            to: format!("buffer view {view_index}"),
        })?;
        let stride = stride.unwrap_or(size);
        if stride < size {
            return Err(fault(format!("a stride of {stride} bytes for elements of {size}")));
        }
        let view_length = count_of(view.byte_length.0, name)?;
        let view_start = count_of(view.byte_offset.map_or(0, |offset| offset.0), name)?;
        let needed = count
            .checked_sub(1)
            .map_or(Some(0), |steps| steps.checked_mul(stride)?.checked_add(size))
            .and_then(|bytes| bytes.checked_add(offset));
        if needed.is_none_or(|needed| needed > view_length) {
            return Err(fault(format!(
                "{count} elements run past buffer view {view_index} of {view_length} bytes"
            )));
        }
        let buffer = view.buffer.value();
        let available = self.load(buffer, name)?.len();
        if view_start.checked_add(view_length).is_none_or(|end| end > available) {
            return Err(fault(format!(
                "buffer view {view_index} runs past buffer {buffer} of {available} bytes"
            )));
        }
        Ok(Layout { start: view_start + offset, stride, buffer })
    }

    /// The bytes of a buffer view.
    pub(super) fn view(&mut self, index: usize, user: &str) -> Result<Vec<u8>, GltfError> {
        let name = format!("buffer view {index} of {user}");
        let view = self.root.buffer_views.get(index).ok_or_else(|| GltfError::Reference {
            from: user.to_owned(),
            to: format!("buffer view {index}"),
        })?;
        let length = count_of(view.byte_length.0, &name)?;
        let layout = self.layout(index, 0, length, 1, None, &name)?;
        let bytes = self.loaded[layout.buffer].as_deref().expect("layout() loaded it");
        Ok(bytes[layout.start..layout.start + length].to_vec())
    }

    fn collect<T>(&self, layout: &Layout, count: usize, size: usize, read: &dyn Fn(&[u8]) -> T) -> Vec<T> {
        let bytes = self.loaded[layout.buffer].as_deref().expect("layout() loaded it");
        (0..count)
            .map(|i| {
                let at = layout.start + i * layout.stride;
                read(&bytes[at..at + size])
            })
            .collect()
    }

    fn load(&mut self, index: usize, user: &str) -> Result<&[u8], GltfError> {
        let buffer = self
            .root
            .buffers
            .get(index)
            .ok_or_else(|| GltfError::Reference { from: user.to_owned(), to: format!("buffer {index}") })?;
        if self.loaded[index].is_none() {
            let fault = |what: String| GltfError::Buffer { index, what };
            let bytes = match (&buffer.uri, self.bin) {
                (None, Some(bin)) if index == 0 => Cow::Borrowed(bin),
                (None, _) => return Err(fault("it has neither a URI nor a BIN chunk".to_owned())),
                (Some(uri), _) => match container::source(uri).map_err(fault)? {
                    container::Source::Inline(bytes) => Cow::Owned(bytes),
                    container::Source::Path(path) => Cow::Owned((self.read)(&path).map_err(fault)?),
                },
            };
            let declared = buffer.byte_length.0;
            if declared > bytes.len() as u64 {
                return Err(fault(format!("it declares {declared} bytes and has {}", bytes.len())));
            }
            self.loaded[index] = Some(bytes);
        }
        Ok(self.loaded[index].as_deref().expect("loaded above"))
    }
}

fn component(accessor: &Accessor) -> Option<ComponentType> {
    match &accessor.component_type {
        Checked::Valid(kind) => Some(kind.0),
        Checked::Invalid => None,
    }
}

fn width(kind: ComponentType) -> usize {
    match kind {
        ComponentType::I8 | ComponentType::U8 => 1,
        ComponentType::I16 | ComponentType::U16 => 2,
        ComponentType::U32 | ComponentType::F32 => 4,
    }
}

fn vector(bytes: &[u8]) -> DVec3 {
    let number = |at: usize| {
        let word = [bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]];
        f64::from(f32::from_le_bytes(word))
    };
    DVec3::new(number(0), number(4), number(8))
}

fn unsigned(bytes: &[u8]) -> u32 {
    bytes.iter().rev().fold(0, |word, &byte| (word << 8) | u32::from(byte))
}

fn count_of(value: u64, name: &str) -> Result<usize, GltfError> {
    usize::try_from(value).map_err(|_| GltfError::Accessor {
        name: name.to_owned(),
        what: format!("{value} is an absurd size"),
    })
}

fn bad_type(name: &str) -> GltfError {
    GltfError::Accessor { name: name.to_owned(), what: "sparse indices of an unknown type".to_owned() }
}
