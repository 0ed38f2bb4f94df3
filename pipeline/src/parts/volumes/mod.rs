//! Hard shadow volumes: what is drawn, and how it is counted.

pub(crate) mod light_contacts;
pub(crate) mod near_cap;
pub(crate) mod near_pyramid;
pub(crate) mod stencil_ranges;
pub(crate) mod volume_draws;
