#include "binding.hpp"

PYBIND11_MODULE(_core, module) {
  using namespace kith::python;
  module.doc() = "kith's libraries; use the package kith.";
  bind_errors(module);
  bind_arrays(module);
  bind_geometry(module);
  bind_belief(module);
  bind_domain(module);
  bind_inference(module);
  bind_own_kinds(module);
  bind_session(module);
  bind_teach(module);
  bind_study(module);
  bind_tables(module);
  bind_results(module);
}
