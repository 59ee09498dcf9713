//! How a type lies in memory, whatever its names: two kernels that see the same words
//! at the same places share a buffer.

use naga::{ArraySize, Handle, Module, Type, TypeInner};

/// A scalar and its place, in bytes.
type Word = (u32, String);

/// The words of a type.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Layout {
    /// Those in front of an array without an end.
    fixed: Vec<Word>,
    /// That array: where it starts, bytes from one element to the next, an element.
    tail: Option<(u32, u32, Vec<Word>)>,
}

impl Layout {
    /// The layout of a type that buffers may have.
    pub fn of(module: &Module, ty: Handle<Type>) -> Self {
        let mut layout = Self::default();
        layout.append(module, ty, 0);
        layout
    }

    /// Whether a kernel may see a buffer like this that has the layout of `ours`: the
    /// same words at the same places, or an array of bare words of the one kind that
    /// there is.
    pub fn stands_for(&self, ours: &Self) -> bool {
        let bare = || match (&self.tail, &ours.tail) {
            (Some((at, _, element)), Some((start, stride, words))) => {
                let dense = (0..*stride).step_by(4).eq(words.iter().map(|word| word.0));
                let kind = |word: &Word| [(0, word.1.clone())] == element[..];
                at == start && dense && words.iter().all(kind)
            }
            _ => false,
        };
        self == ours || (self.fixed == ours.fixed && bare())
    }

    fn append(&mut self, module: &Module, ty: Handle<Type>, at: u32) {
        match &module.types[ty].inner {
            TypeInner::Scalar(scalar) | TypeInner::Atomic(scalar) => {
                self.fixed.push((at, scalar_name(*scalar)));
            }
            TypeInner::Vector { size, scalar } => {
                let width = u32::from(scalar.width);
                for i in 0..*size as u32 {
                    self.fixed.push((at + i * width, scalar_name(*scalar)));
                }
            }
            TypeInner::Struct { members, .. } => {
                for member in members {
                    self.append(module, member.ty, at + member.offset);
                }
            }
            TypeInner::Array { base, size, stride } => match size {
                ArraySize::Constant(count) => {
                    for i in 0..count.get() {
                        self.append(module, *base, at + i * stride);
                    }
                }
                _ => self.tail = Some((at, *stride, Self::of(module, *base).fixed)),
            },
            // A matrix, say: no stage has one, so that any name tells it apart.
            other => self.fixed.push((at, format!("{other:?}"))),
        }
    }
}

fn scalar_name(scalar: naga::Scalar) -> String {
    let kind = match scalar.kind {
        naga::ScalarKind::Sint => "i",
        naga::ScalarKind::Uint => "u",
        naga::ScalarKind::Float => "f",
        _ => "bool",
    };
    format!("{kind}{}", 8 * u32::from(scalar.width))
}

/// A type as WGSL writes it, structs by their names.
pub fn type_name(module: &Module, ty: Handle<Type>) -> String {
    let ty = &module.types[ty];
    match &ty.inner {
        TypeInner::Scalar(scalar) => scalar_name(*scalar),
        TypeInner::Atomic(scalar) => format!("atomic<{}>", scalar_name(*scalar)),
        TypeInner::Vector { size, scalar } => {
            format!("vec{}<{}>", *size as u32, scalar_name(*scalar))
        }
        TypeInner::Array { base, size, .. } => {
            let base = type_name(module, *base);
            match size {
                ArraySize::Constant(count) => format!("array<{base}, {count}>"),
                _ => format!("array<{base}>"),
            }
        }
        other => ty.name.clone().unwrap_or_else(|| format!("{other:?}")),
    }
}
