//! A model checker's atomics and cells, which also tell when their memory was freed.

/// Wraps a checker's `AtomicPtr` and a cell. In cells of their own, as an arena writes a new
/// node over an old one that others still have a reference to.
macro_rules! checked {
    ($($atomic:ident)::+, $($cell:ident)::+) => {
        /// A pointer that others may change.
        pub struct AtomicPtr<T>(std::cell::UnsafeCell<Pointer<T>>);

        type Pointer<T> = $($atomic)::+<T>;
        type Inner<T> = $($cell)::+<T>;

        // SAFETY: the model runs its threads in turns, all on one.
        #[expect(unsafe_code, reason = "in place of an atomic")]
        unsafe impl<T> Send for AtomicPtr<T> {}
        // SAFETY: as above.
        #[expect(unsafe_code, reason = "in place of an atomic")]
        unsafe impl<T> Sync for AtomicPtr<T> {}

        #[expect(unsafe_code, reason = "in place of an atomic")]
        impl<T> AtomicPtr<T> {
            pub fn new(value: *mut T) -> Self {
                Self(std::cell::UnsafeCell::new(Pointer::new(value)))
            }

            /// Checks afterwards, as others have their turn before an operation.
            fn done<R>(&self, result: R) -> R {
                crate::support::heap::check((&raw const *self).addr());
                result
            }

            fn inner(&self) -> &Pointer<T> {
                // SAFETY: threads have turns.
                unsafe { &*self.0.get() }
            }

            pub fn load(&self, order: Ordering) -> *mut T {
                self.done(self.inner().load(order))
            }

            pub fn store(&self, value: *mut T, order: Ordering) {
                self.done(self.inner().store(value, order));
            }

            pub fn compare_exchange(
                &self,
                from: *mut T,
                to: *mut T,
                success: Ordering,
                failure: Ordering,
            ) -> Result<*mut T, *mut T> {
                self.done(self.inner().compare_exchange(from, to, success, failure))
            }
        }

        impl<T> Drop for AtomicPtr<T> {
            /// Being freed is an access like others, that the checker puts before and after
            /// theirs.
            fn drop(&mut self) {
                if !std::thread::panicking() {
                    self.0
                        .get_mut()
                        .store(std::ptr::null_mut(), Ordering::Relaxed);
                }
            }
        }

        /// A cell that the checker watches.
        pub struct UnsafeCell<T>(std::cell::UnsafeCell<Inner<T>>);

        #[expect(unsafe_code, reason = "in place of a cell")]
        impl<T> UnsafeCell<T> {
            pub fn new(value: T) -> Self {
                Self(std::cell::UnsafeCell::new(Inner::new(value)))
            }

            fn inner(&self) -> &Inner<T> {
                crate::support::heap::check((&raw const *self).addr());
                // SAFETY: threads have turns.
                unsafe { &*self.0.get() }
            }

            pub fn with<R>(&self, read: impl FnOnce(*const T) -> R) -> R {
                self.inner().with(read)
            }

            pub fn with_mut<R>(&self, write: impl FnOnce(*mut T) -> R) -> R {
                self.inner().with_mut(write)
            }
        }

        impl<T> Drop for UnsafeCell<T> {
            /// Who frees it must come after all who used it.
            fn drop(&mut self) {
                if !std::thread::panicking() {
                    self.0.get_mut().with_mut(|_| ());
                }
            }
        }
    };
}
