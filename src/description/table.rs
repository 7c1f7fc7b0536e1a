//! What a model description says, as data: variables, units, structure, capabilities.

/// FMI 2.0 `causality` (section 2.2.7).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Causality {
    Parameter,
    Input,
    Output,
    Local,
    Independent,
}

/// FMI 2.0 `variability` (section 2.2.7).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Variability {
    Constant,
    Fixed,
    Tunable,
    Discrete,
    Continuous,
}

/// FMI 2.0 `initial` (section 2.2.7).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Initial {
    Exact,
    Approx,
    Calculated,
}

/// The base type of a variable; value references count per type.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum VariableType {
    Real,
    Integer,
    Boolean,
}

/// Inclusive limits of a numeric variable; `None` where there is none.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Bounds<T> {
    pub min: Option<T>,
    pub max: Option<T>,
}

/// Type-specific attributes of a variable.
#[derive(Debug, Clone, PartialEq)]
pub enum Kind {
    Real {
        start: Option<f64>,
        bounds: Bounds<f64>,
        nominal: Option<f64>,
        unit: Option<&'static str>,
        display_unit: Option<&'static str>,
        /// Name of the continuous state whose derivative this variable is.
        derivative_of: Option<String>,
    },
    Integer {
        start: Option<i32>,
        bounds: Bounds<i32>,
    },
    Boolean {
        start: Option<bool>,
    },
}

/// One scalar variable of a model description.
#[derive(Debug, Clone, PartialEq)]
pub struct Variable {
    pub name: String,
    pub value_reference: u32,
    pub description: String,
    pub causality: Causality,
    pub variability: Variability,
    /// `None` where the standard's table leaves it out (inputs, the independent variable).
    pub initial: Option<Initial>,
    pub kind: Kind,
    /// A Real input that a host may set to NaN or infinity for want of a value: the model goes on
    /// with the last valid one and knows that it does. Everywhere else such numbers are refused.
    pub may_be_missing: bool,
}

/// An entry of `ModelStructure`: an unknown and the knowns it depends on, all by name.
#[derive(Debug, Clone, PartialEq)]
pub struct Unknown {
    pub variable: String,
    pub dependencies: Vec<String>,
}

/// `DefaultExperiment` (section 2.2.5), seconds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DefaultExperiment {
    pub start_time: f64,
    pub stop_time: f64,
    pub tolerance: f64,
    pub step_size: f64,
}

/// Optional capabilities that a model really has; what is the same for every FMU of this crate
/// (state access, serialization, many instances a process) stands in the rendering.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Capabilities {
    /// Highest order of `fmi2GetRealOutputDerivatives`.
    pub max_output_derivative_order: u32,
    /// `fmi2SetRealInputDerivatives` is honoured.
    pub can_interpolate_inputs: bool,
    /// `fmi2GetDirectionalDerivative` works.
    pub provides_directional_derivative: bool,
}

/// A whole model description, before it is rendered.
#[derive(Debug, Clone, PartialEq)]
pub struct Definition {
    pub model_identifier: &'static str,
    pub description: &'static str,
    /// Ordered as in the XML; the independent variable first.
    pub variables: Vec<Variable>,
    /// `ModelStructure/Outputs`: every output, knowns are inputs, continuous states and time.
    pub outputs: Vec<Unknown>,
    /// `ModelStructure/Derivatives` in the order of the continuous states.
    pub derivatives: Vec<Unknown>,
    /// `ModelStructure/InitialUnknowns`: knowns are inputs and every variable with `initial = exact`.
    pub initial_unknowns: Vec<Unknown>,
    pub default_experiment: DefaultExperiment,
    pub capabilities: Capabilities,
    /// Number of event indicators; none of our models has state events.
    pub event_indicators: usize,
}

impl Variable {
    fn new(name: &str, value_reference: u32, description: &str, kind: Kind) -> Self {
        Self {
            name: name.to_owned(),
            value_reference,
            description: description.to_owned(),
            causality: Causality::Local,
            variability: Variability::Continuous,
            initial: Some(Initial::Calculated),
            kind,
            may_be_missing: false,
        }
    }

    /// A calculated, continuous local Real; the methods below turn it into what is wanted.
    pub fn real(name: &str, value_reference: u32, unit: Option<&'static str>, description: &str) -> Self {
        let kind = Kind::Real {
            start: None,
            bounds: Bounds::default(),
            nominal: None,
            unit,
            display_unit: None,
            derivative_of: None,
        };
        Self::new(name, value_reference, description, kind)
    }

    /// A calculated, discrete local Integer.
    pub fn integer(name: &str, value_reference: u32, description: &str) -> Self {
        let kind = Kind::Integer { start: None, bounds: Bounds::default() };
        Self::new(name, value_reference, description, kind).discrete()
    }

    /// A calculated, discrete local Boolean.
    pub fn boolean(name: &str, value_reference: u32, description: &str) -> Self {
        Self::new(name, value_reference, description, Kind::Boolean { start: None }).discrete()
    }

    /// The independent variable `time` with value reference 0.
    pub fn time() -> Self {
        Self { causality: Causality::Independent, initial: None, ..Self::real("time", 0, Some("s"), "Simulation time") }
    }

    pub fn input(mut self) -> Self {
        self.causality = Causality::Input;
        self.initial = None;
        self
    }

    /// An input whose value may be missing, see [`Variable::may_be_missing`].
    pub fn measurement(self) -> Self {
        Self { may_be_missing: true, ..self.input() }
    }

    pub fn output(mut self) -> Self {
        self.causality = Causality::Output;
        self
    }

    /// A parameter that is fixed after initialization.
    pub fn parameter(mut self) -> Self {
        self.causality = Causality::Parameter;
        self.variability = Variability::Fixed;
        self.initial = Some(Initial::Exact);
        self
    }

    /// A parameter that may change between steps and at events.
    pub fn tunable(self) -> Self {
        Self { variability: Variability::Tunable, ..self.parameter() }
    }

    pub fn discrete(mut self) -> Self {
        self.variability = Variability::Discrete;
        self
    }

    /// Start value of a Real.
    pub fn start(mut self, value: f64) -> Self {
        if let Kind::Real { start, .. } = &mut self.kind {
            *start = Some(value);
        }
        self
    }

    /// Start value of an Integer.
    pub fn start_integer(mut self, value: i32) -> Self {
        if let Kind::Integer { start, .. } = &mut self.kind {
            *start = Some(value);
        }
        self
    }

    /// Start value of a Boolean.
    pub fn start_boolean(mut self, value: bool) -> Self {
        if let Kind::Boolean { start } = &mut self.kind {
            *start = Some(value);
        }
        self
    }

    /// Inclusive limits of a Real; an infinite one is left out of the XML.
    pub fn range(mut self, min: f64, max: f64) -> Self {
        if let Kind::Real { bounds, .. } = &mut self.kind {
            *bounds = Bounds { min: Some(min).filter(|x| x.is_finite()), max: Some(max).filter(|x| x.is_finite()) };
        }
        self
    }

    /// Inclusive limits of an Integer.
    pub fn range_integer(mut self, min: i32, max: i32) -> Self {
        if let Kind::Integer { bounds, .. } = &mut self.kind {
            *bounds = Bounds { min: Some(min), max: Some(max) };
        }
        self
    }

    pub fn nominal(mut self, value: f64) -> Self {
        if let Kind::Real { nominal, .. } = &mut self.kind {
            *nominal = Some(value);
        }
        self
    }

    pub fn display(mut self, unit: &'static str) -> Self {
        if let Kind::Real { display_unit, .. } = &mut self.kind {
            *display_unit = Some(unit);
        }
        self
    }

    /// Marks this Real as the time derivative of the continuous state `state`.
    pub fn derivative_of(mut self, state: &str) -> Self {
        if let Kind::Real { derivative_of, .. } = &mut self.kind {
            *derivative_of = Some(state.to_owned());
        }
        self
    }

    /// The FMI base type.
    pub fn variable_type(&self) -> VariableType {
        match self.kind {
            Kind::Real { .. } => VariableType::Real,
            Kind::Integer { .. } => VariableType::Integer,
            Kind::Boolean { .. } => VariableType::Boolean,
        }
    }
}
