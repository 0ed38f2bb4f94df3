//! Hard shadow volumes: what is drawn, and how it is counted.

pub(crate) mod near_pyramid;
pub(crate) mod volume_draws;
