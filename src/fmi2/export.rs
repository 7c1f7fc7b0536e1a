//! The exported symbols. They come from a macro that each shared library invokes: `no_mangle`
//! functions of this library would be dropped by the linker, or clash.

/// Exports all 44 functions of FMI 2.0 over a type that implements [`Model`](crate::fmi2::Model).
#[macro_export]
macro_rules! export_fmu {
    ($model:ty) => {
        #[unsafe(no_mangle)]
        #[doc = "FMI 2.0 section 2.1.4"]
        pub extern "C" fn fmi2GetTypesPlatform() -> *const ::std::ffi::c_char {
            $crate::fmi2::api::get_types_platform()
        }

        #[unsafe(no_mangle)]
        #[doc = "FMI 2.0 section 2.1.4"]
        pub extern "C" fn fmi2GetVersion() -> *const ::std::ffi::c_char {
            $crate::fmi2::api::get_version()
        }

        #[unsafe(no_mangle)]
        #[doc = "FMI 2.0 section 2.1.5"]
        /// # Safety
        /// As the standard says; see [`rps3::fmi2::api`].
        pub unsafe extern "C" fn fmi2Instantiate(
            instance_name: *const ::std::ffi::c_char,
            fmu_type: ::std::ffi::c_int,
            guid: *const ::std::ffi::c_char,
            _resource_location: *const ::std::ffi::c_char,
            functions: *const $crate::fmi2::types::CallbackFunctions,
            _visible: $crate::fmi2::types::Boolean,
            logging_on: $crate::fmi2::types::Boolean,
        ) -> $crate::fmi2::types::Component {
            static LAYOUT: $crate::fmi2::Lasting<$crate::fmi2::Layout> = $crate::fmi2::Lasting::new();
            // SAFETY: passed on to the caller.
            unsafe {
                $crate::fmi2::api::instantiate::<$model>(
                    instance_name, fmu_type, guid, functions, logging_on, &LAYOUT)
            }
        }

        #[unsafe(no_mangle)]
        #[doc = "FMI 2.0 section 2.1.5"]
        /// # Safety
        /// As the standard says; see [`rps3::fmi2::api`].
        pub unsafe extern "C" fn fmi2FreeInstance(component: $crate::fmi2::types::Component) {
            // SAFETY: passed on to the caller.
            unsafe { $crate::fmi2::api::free_instance::<$model>(component) }
        }

        $crate::export_fmu! { @on_instance $model;
            fmi2SetDebugLogging = set_debug_logging(on: Boolean, count: usize, categories: *const *const c_char);
            fmi2SetupExperiment = setup_experiment(
                tolerance_defined: Boolean, tolerance: f64, start_time: f64, stop_time_defined: Boolean, stop_time: f64);
            fmi2EnterInitializationMode = enter_initialization_mode();
            fmi2ExitInitializationMode = exit_initialization_mode();
            fmi2Terminate = terminate();
            fmi2Reset = reset();
            fmi2GetReal = get_real(vr: *const ValueReference, count: usize, value: *mut f64);
            fmi2GetInteger = get_integer(vr: *const ValueReference, count: usize, value: *mut c_int);
            fmi2GetBoolean = get_boolean(vr: *const ValueReference, count: usize, value: *mut Boolean);
            fmi2GetString = get_string(vr: *const ValueReference, count: usize, value: *mut *const c_char);
            fmi2SetReal = set_real(vr: *const ValueReference, count: usize, value: *const f64);
            fmi2SetInteger = set_integer(vr: *const ValueReference, count: usize, value: *const c_int);
            fmi2SetBoolean = set_boolean(vr: *const ValueReference, count: usize, value: *const Boolean);
            fmi2SetString = set_string(vr: *const ValueReference, count: usize, value: *const *const c_char);
            fmi2GetFMUstate = get_fmu_state(state: *mut FmuState);
            fmi2SetFMUstate = set_fmu_state(state: FmuState);
            fmi2FreeFMUstate = free_fmu_state(state: *mut FmuState);
            fmi2SerializedFMUstateSize = serialized_fmu_state_size(state: FmuState, size: *mut usize);
            fmi2SerializeFMUstate = serialize_fmu_state(state: FmuState, bytes: *mut u8, size: usize);
            fmi2DeSerializeFMUstate = deserialize_fmu_state(bytes: *const u8, size: usize, state: *mut FmuState);
            fmi2GetDirectionalDerivative = get_directional_derivative(
                unknowns: *const ValueReference, unknown_count: usize, knowns: *const ValueReference, known_count: usize,
                seed: *const f64, derivative: *mut f64);
            fmi2EnterEventMode = enter_event_mode();
            fmi2NewDiscreteStates = new_discrete_states(event_info: *mut EventInfo);
            fmi2EnterContinuousTimeMode = enter_continuous_time_mode();
            fmi2CompletedIntegratorStep = completed_integrator_step(
                no_set_fmu_state: Boolean, enter_event_mode: *mut Boolean, terminate: *mut Boolean);
            fmi2SetTime = set_time(time: f64);
            fmi2SetContinuousStates = set_continuous_states(states: *const f64, count: usize);
            fmi2GetEventIndicators = get_event_indicators(indicators: *mut f64, count: usize);
            fmi2GetContinuousStates = get_continuous_states(states: *mut f64, count: usize);
            fmi2GetDerivatives = get_derivatives(derivatives: *mut f64, count: usize);
            fmi2GetNominalsOfContinuousStates = get_nominals_of_continuous_states(nominals: *mut f64, count: usize);
            fmi2SetRealInputDerivatives = set_real_input_derivatives(
                vr: *const ValueReference, count: usize, order: *const c_int, value: *const f64);
            fmi2GetRealOutputDerivatives = get_real_output_derivatives(
                vr: *const ValueReference, count: usize, order: *const c_int, value: *mut f64);
            fmi2DoStep = do_step(point: f64, step: f64, no_set_fmu_state: Boolean);
            fmi2CancelStep = cancel_step();
            fmi2GetStatus = get_status(kind: c_int, value: *mut c_int);
            fmi2GetRealStatus = get_real_status(kind: c_int, value: *mut f64);
            fmi2GetIntegerStatus = get_integer_status(kind: c_int, value: *mut c_int);
            fmi2GetBooleanStatus = get_boolean_status(kind: c_int, value: *mut Boolean);
            fmi2GetStringStatus = get_string_status(kind: c_int, value: *mut *const c_char);
        }
    };
    (@on_instance $model:ty; $($name:ident = $function:ident($($argument:ident: $type:ty),*);)*) => {
        #[allow(unused_imports)]
        use $crate::fmi2::types::{Boolean, EventInfo, FmuState, ValueReference};
        #[allow(unused_imports)]
        use ::std::ffi::{c_char, c_int};
        $(
            #[unsafe(no_mangle)]
            #[doc = concat!("`", stringify!($name), "` of FMI 2.0.")]
            /// # Safety
            /// As the standard says; see [`rps3::fmi2::api`].
            #[allow(clippy::too_many_arguments)]
            pub unsafe extern "C" fn $name(
                component: $crate::fmi2::types::Component
                $(, $argument: $type)*
            ) -> $crate::fmi2::types::Status {
                // SAFETY: passed on to the caller.
                unsafe { $crate::fmi2::api::$function::<$model>(component $(, $argument)*) }
            }
        )*
    };
}
