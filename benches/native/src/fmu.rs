//! An FMU's C functions, as a small master sees them.

use std::ffi::{CString, c_char, c_int, c_void};
use std::ptr::{null, null_mut};

use anyhow::{Context, Result, ensure};
use libloading::Library;
use rps3::fmi2::Model;
use rps3::fmi2::types::{Boolean, CallbackFunctions, Component, Status, ValueReference};

type Instantiate = unsafe extern "C" fn(
    *const c_char,
    c_int,
    *const c_char,
    *const c_char,
    *const CallbackFunctions,
    Boolean,
    Boolean,
) -> Component;
type Plain = unsafe extern "C" fn(Component) -> c_int;

/// A loaded library; leaked, since instances refer to it until the process ends.
#[derive(Clone, Copy)]
pub struct Fmu {
    instantiate: Instantiate,
    setup_experiment: unsafe extern "C" fn(Component, Boolean, f64, f64, Boolean, f64) -> c_int,
    enter_initialization_mode: Plain,
    exit_initialization_mode: Plain,
    free_instance: unsafe extern "C" fn(Component),
    get_real: unsafe extern "C" fn(Component, *const ValueReference, usize, *mut f64) -> c_int,
    set_real: unsafe extern "C" fn(Component, *const ValueReference, usize, *const f64) -> c_int,
    set_integer: unsafe extern "C" fn(Component, *const ValueReference, usize, *const c_int) -> c_int,
    do_step: unsafe extern "C" fn(Component, f64, f64, Boolean) -> c_int,
}

impl Fmu {
    pub fn load(path: &str) -> Result<Self> {
        // SAFETY: FMUs run no code when they are loaded beyond what their languages need.
        let library: &Library = Box::leak(Box::new(unsafe { Library::new(path) }.with_context(|| path.to_owned())?));
        macro_rules! function {
            // SAFETY: the standard gives the function this type.
            ($name:literal) => {
                *unsafe { library.get($name) }?
            };
        }
        Ok(Self {
            instantiate: function!(b"fmi2Instantiate"),
            setup_experiment: function!(b"fmi2SetupExperiment"),
            enter_initialization_mode: function!(b"fmi2EnterInitializationMode"),
            exit_initialization_mode: function!(b"fmi2ExitInitializationMode"),
            free_instance: function!(b"fmi2FreeInstance"),
            get_real: function!(b"fmi2GetReal"),
            set_real: function!(b"fmi2SetReal"),
            set_integer: function!(b"fmi2SetInteger"),
            do_step: function!(b"fmi2DoStep"),
        })
    }

    /// A Co-Simulation instance in the state `instantiated`.
    pub fn instantiate(self, guid: &str) -> Result<Instance> {
        let (name, guid) = (c"bench", CString::new(guid)?);
        let callbacks = Box::leak(Box::new(CallbackFunctions {
            logger: None,
            allocate_memory: Some(allocate),
            free_memory: Some(free),
            step_finished: None,
            component_environment: null_mut(),
        }));
        // SAFETY: pointers to living data, and the standard allows a null resource location.
        let component = unsafe { (self.instantiate)(name.as_ptr(), 1, guid.as_ptr(), null(), callbacks, 0, 0) };
        ensure!(!component.is_null(), "no instance");
        Ok(Instance { fmu: self, component })
    }
}

unsafe extern "C" {
    fn calloc(count: usize, size: usize) -> *mut c_void;
    #[link_name = "free"]
    fn c_free(memory: *mut c_void);
}

unsafe extern "C" fn allocate(count: usize, size: usize) -> *mut c_void {
    // SAFETY: any arguments are allowed.
    unsafe { calloc(count, size) }
}

unsafe extern "C" fn free(memory: *mut c_void) {
    // SAFETY: the FMU frees what `allocate` gave it.
    unsafe { c_free(memory) }
}

/// An instance, freed when dropped.
pub struct Instance {
    fmu: Fmu,
    component: Component,
}

// SAFETY: one thread at a time uses an instance, which is all that the standard asks for.
unsafe impl Send for Instance {}

impl Instance {
    /// Through Initialization Mode, from time 0 to an open end.
    pub fn initialize(&mut self, tolerance: f64) -> Result<()> {
        // SAFETY: here and below: the component lives, arrays have the stated lengths.
        unsafe {
            check((self.fmu.setup_experiment)(self.component, 1, tolerance, 0.0, 0, 0.0))?;
            check((self.fmu.enter_initialization_mode)(self.component))?;
            check((self.fmu.exit_initialization_mode)(self.component))
        }
    }

    pub fn get(&mut self, references: &[ValueReference], values: &mut [f64]) -> Result<()> {
        assert_eq!(references.len(), values.len());
        // SAFETY: see `initialize`.
        check(unsafe { (self.fmu.get_real)(self.component, references.as_ptr(), values.len(), values.as_mut_ptr()) })
    }

    pub fn set(&mut self, references: &[ValueReference], values: &[f64]) -> Result<()> {
        assert_eq!(references.len(), values.len());
        // SAFETY: see `initialize`.
        check(unsafe { (self.fmu.set_real)(self.component, references.as_ptr(), values.len(), values.as_ptr()) })
    }

    pub fn set_integer(&mut self, reference: ValueReference, value: i32) -> Result<()> {
        // SAFETY: see `initialize`.
        check(unsafe { (self.fmu.set_integer)(self.component, &reference, 1, &value) })
    }

    pub fn step(&mut self, time: f64, size: f64) -> Result<()> {
        // SAFETY: see `initialize`.
        check(unsafe { (self.fmu.do_step)(self.component, time, size, 1) })
    }
}

impl Drop for Instance {
    fn drop(&mut self) {
        // SAFETY: freed once.
        unsafe { (self.fmu.free_instance)(self.component) }
    }
}

fn check(status: c_int) -> Result<()> {
    ensure!(status <= Status::Warning as c_int, "fmi2Status {status}");
    Ok(())
}

/// Value references of a model's variables by name.
pub fn references<M: Model>(names: &[String]) -> Result<Vec<ValueReference>> {
    let variables = &M::definition().variables;
    names
        .iter()
        .map(|name| {
            let variable = variables.iter().find(|v| v.name == *name).with_context(|| format!("no {name}"))?;
            Ok(variable.value_reference)
        })
        .collect()
}
