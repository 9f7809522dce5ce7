//! Typed indices: vertex, triangle, half-edge.

/// Marks an absent index (no twin: the half-edge lies on the boundary).
pub(crate) const NONE: u32 = u32::MAX;

macro_rules! id {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
        pub struct $name(pub u32);

        impl $name {
            /// The index as `usize`, for slices.
            #[inline]
            pub fn index(self) -> usize {
                self.0 as usize
            }
        }
    };
}

id!(
    /// A vertex: one point in world space. Valid until the next edit.
    VertexId
);
id!(
    /// A triangle. Valid until the next edit.
    TriangleId
);
id!(
    /// Half-edge `3 t + k`: from corner `k` of triangle `t` to its next corner.
    HalfEdge
);

impl HalfEdge {
    /// The next half-edge in the same triangle.
    #[inline]
    pub fn next(self) -> HalfEdge {
        HalfEdge(if self.0 % 3 == 2 { self.0 - 2 } else { self.0 + 1 })
    }

    /// The previous half-edge in the same triangle.
    #[inline]
    pub fn prev(self) -> HalfEdge {
        HalfEdge(if self.0.is_multiple_of(3) { self.0 + 2 } else { self.0 - 1 })
    }

    /// The triangle it belongs to.
    #[inline]
    pub fn triangle(self) -> TriangleId {
        TriangleId(self.0 / 3)
    }

    /// The corner it starts from: 0, 1 or 2.
    #[inline]
    pub fn corner(self) -> usize {
        (self.0 % 3) as usize
    }
}

impl TriangleId {
    /// Its half-edge that starts at corner `k` (0, 1 or 2).
    #[inline]
    pub fn half_edge(self, k: usize) -> HalfEdge {
        HalfEdge(3 * self.0 + k as u32)
    }
}
