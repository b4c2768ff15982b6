//! When something last changed at each vertex, so that what failed is tried again only where it may succeed.

use super::VertexId;

/// The time of the last change at each vertex, by a clock that advances with each change.
#[derive(Clone, Debug)]
pub(crate) struct Changes {
    now: u32,
    /// 0: never.
    of_vertex: Vec<u32>,
}

impl Changes {
    /// A clock that starts now. Every change must be recorded that is made while a record of failures is in
    /// use.
    pub(crate) fn new() -> Self {
        Self { now: 1, of_vertex: Vec::new() }
    }

    /// The current time, above 0.
    pub(crate) fn now(&self) -> u32 {
        self.now
    }

    /// Whether nothing at a vertex has changed since `time`; false if `time` is 0.
    pub(crate) fn none_since(&self, vertex: VertexId, time: u32) -> bool {
        time > 0 && self.of_vertex.get(vertex.index()).is_none_or(|&changed| changed < time)
    }

    /// Records a change at vertices.
    pub(crate) fn record(&mut self, vertices: impl IntoIterator<Item = VertexId>) {
        for v in vertices {
            *entry(&mut self.of_vertex, v.index()) = self.now;
        }
        self.now += 1;
    }
}

/// The entry at an index; the list grows if it is shorter.
pub(crate) fn entry<T: Clone + Default>(times: &mut Vec<T>, i: usize) -> &mut T {
    if times.len() <= i {
        times.resize(i + 1, T::default());
    }
    &mut times[i]
}
