//! Buffers by the names of the variables that they are bound to.

/// Some of them.
pub(crate) struct Named(Vec<(&'static str, wgpu::Buffer)>);

impl From<Vec<(&'static str, wgpu::Buffer)>> for Named {
    fn from(buffers: Vec<(&'static str, wgpu::Buffer)>) -> Self {
        Self(buffers)
    }
}

impl Named {
    /// Puts a buffer in place of another of its name, or adds it.
    pub(crate) fn set(&mut self, name: &'static str, buffer: wgpu::Buffer) {
        self.0.retain(|(other, _)| *other != name);
        self.0.push((name, buffer));
    }

    /// A buffer by its name.
    ///
    /// # Panics
    /// If there is none, which is a mistake of the host.
    pub(crate) fn get(&self, name: &str) -> &wgpu::Buffer {
        let found = self.0.iter().find(|(other, _)| *other == name);
        &found.expect("a buffer that was made before").1
    }

    /// Exchanges two buffers.
    pub(crate) fn swap(&mut self, [a, b]: [&'static str; 2]) {
        for (name, _) in &mut self.0 {
            *name = match *name {
                name if name == a => b,
                name if name == b => a,
                other => other,
            };
        }
    }

    /// Bytes of all.
    pub(crate) fn bytes(&self) -> u64 {
        self.0.iter().map(|(_, buffer)| buffer.size()).sum()
    }

    /// Names and buffers.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (&str, &wgpu::Buffer)> {
        self.0.iter().map(|(name, buffer)| (*name, buffer))
    }
}
