#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

/// The module `kith._core`: kith's libraries as Python sees them. The package `kith` (python/kith) is built on it;
/// people use that. Nothing here links numpy: arrays cross the border by the buffer protocol, so that any numpy will
/// do.
namespace kith::python {

namespace py = pybind11;

// One function per file, in the order in which classes have to be known.
void bind_errors(py::module_& module);
void bind_arrays(py::module_& module);
void bind_geometry(py::module_& module);
void bind_belief(py::module_& module);
void bind_domain(py::module_& module);
void bind_inference(py::module_& module);
void bind_own_kinds(py::module_& module);
void bind_session(py::module_& module);
void bind_teach(py::module_& module);
void bind_study(py::module_& module);
void bind_tables(py::module_& module);
void bind_results(py::module_& module);

}  // namespace kith::python
