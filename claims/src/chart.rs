//! A plot as plain data: what is drawn, not how. Whoever draws it chooses sizes,
//! colours and file formats.

/// A plot of one or more series over common axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Chart {
    /// For file names: kebab-case, unique among the charts of one run.
    pub name: String,
    /// One line above the plot.
    pub title: String,
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// What is plotted, in the order of the legend.
    pub series: Vec<Series>,
}

/// An axis.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Axis {
    /// What is measured, with its unit.
    pub label: String,
    /// How values become places.
    pub scale: Scale,
}

/// How values become places along an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scale {
    /// Evenly; the axis includes 0.
    #[default]
    Linear,
    /// By decades; values that are not above 0 cannot be shown.
    Log10,
    /// By doublings, for powers of two; values that are not above 0 cannot be shown.
    Log2,
}

/// How a series is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mark {
    /// Dots joined by a line in the order given.
    #[default]
    Line,
    /// Dots alone.
    Dots,
    /// A bar from the bottom at each value.
    Bars,
    /// A dashed line in the order given, without dots: a limit or a trend.
    Dashed,
}

/// Points under one name.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Shown in the legend.
    pub label: String,
    /// x and y of each point.
    pub points: Vec<[f64; 2]>,
    /// How they are drawn.
    pub mark: Mark,
}

impl Axis {
    /// An axis that includes 0.
    pub fn linear(label: &str) -> Self {
        Self::scaled(label, Scale::Linear)
    }

    /// An axis by decades.
    pub fn log10(label: &str) -> Self {
        Self::scaled(label, Scale::Log10)
    }

    /// An axis by doublings.
    pub fn log2(label: &str) -> Self {
        Self::scaled(label, Scale::Log2)
    }

    fn scaled(label: &str, scale: Scale) -> Self {
        Self {
            label: label.to_owned(),
            scale,
        }
    }
}

impl Series {
    /// Dots joined by a line.
    pub fn line(label: &str, points: Vec<[f64; 2]>) -> Self {
        Self::marked(label, points, Mark::Line)
    }

    /// Points drawn as `mark` says.
    pub fn marked(label: &str, points: Vec<[f64; 2]>, mark: Mark) -> Self {
        Self {
            label: label.to_owned(),
            points,
            mark,
        }
    }
}
