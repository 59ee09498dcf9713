//! Materials of an OBJ file: which triangle has which, and what libraries say of
//! them.

use std::collections::BTreeMap;

use super::super::{MATERIALS_MAX, Named, mtl};

/// Materials so far.
#[derive(Default)]
pub(super) struct Materials {
    /// Numbers by name, from 1 in order of first use; 0 stands for none.
    used: BTreeMap<String, u32>,
    /// The number of the one in use.
    chosen: u32,
    /// A number for each triangle.
    of_triangle: Vec<u32>,
    /// What the libraries define.
    pub(super) library: mtl::Library,
}

impl Materials {
    /// `usemtl name`: for the triangles that follow.
    pub(super) fn choose(&mut self, name: String) -> Result<(), String> {
        let next = self.used.len() as u64 + 1;
        let number = u32::try_from(next).expect("at most one more than MATERIALS_MAX");
        self.chosen = *self.used.entry(name).or_insert(number);
        match self.used.len() as u64 > MATERIALS_MAX {
            false => Ok(()),
            true => Err(format!(
                "{next} materials exceed the limit of {MATERIALS_MAX}"
            )),
        }
    }

    /// Adds triangles of the material in use.
    pub(super) fn add(&mut self, triangles: usize) {
        let count = self.of_triangle.len() + triangles;
        self.of_triangle.resize(count, self.chosen);
    }

    /// The material of each triangle, and the materials by number.
    pub(super) fn finish(self) -> (Vec<u32>, Vec<Named>) {
        let mut named = vec![Named::default(); self.used.len() + 1];
        for (name, number) in self.used {
            let defined = self.library.find(&name);
            named[number as usize] = Named { name, defined };
        }
        (self.of_triangle, named)
    }
}
