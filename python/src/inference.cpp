#include "kith/bec/inference.hpp"
#include "arrays.hpp"
#include "binding.hpp"
#include "domain.hpp"
#include "errors.hpp"
#include "kith/core/error.hpp"
#include "kith/domains/variation.hpp"
#include "waiting.hpp"

namespace kith::python {
namespace {

std::size_t number_of(const Domain& domain, StartId id) { return state_number(domain, id.mdp, id.start); }

py::dict to_python(const Domain& domain, const WeightInference& inference) {
  py::list unexplained, sides, clashes;
  for (const auto& one : inference.unexplained) unexplained.append(number_of(domain, one.state));
  for (const auto& side : inference.sides)
    sides.append(py::make_tuple(to_list(std::vector<HalfSpace>{side.half_space})[0], side.support));
  for (const auto& clash : inference.clashes) {
    py::list states;
    for (const auto& state : clash.states) states.append(number_of(domain, state));
    clashes.append(states);
  }
  py::dict result;
  result["region"] = inference.region;
  result["weights"] = py::tuple(py::cast(std::vector<double>{inference.weights}));
  result["share"] = inference.share;
  result["loss"] = inference.loss;
  result["margin"] = inference.margin;
  result["unexplained"] = unexplained;
  result["sides"] = sides;
  result["clashes"] = clashes;
  return result;
}

// The domain with the weights that explain the policy, and what is known of them.
py::tuple infer(const std::string& text, const std::string& name, const py::dict& files, const std::string& policy) {
  DomainFiles named;
  for (const auto& [file, content] : files)
    named.known.push_back({file.cast<std::string>(), content.cast<std::string>()});
  auto open = parse_unweighed_domain(text, name, named);
  if (!open.domain) throw Error{open.diagnostics};
  warn(open.diagnostics);
  const auto reading = parse_policy(policy, "policy", *open.domain);
  if (!reading.policy) throw Error{reading.diagnostics};
  const auto inference = wait_for([&] { return infer_weights(*open.domain, *reading.policy); });
  auto written = with_inferred_weights(text, open.domain->feature_names(), inference.weights, as_inferred(inference),
                                       inference.left_out);
  auto weighed = parse_domain(written, name, {}, named);
  if (!weighed.domain) throw Error{weighed.diagnostics};
  const auto domain =
      std::make_shared<LoadedDomain>(*std::move(weighed.domain), std::move(written), std::move(weighed.files));
  return py::make_tuple(domain, to_python(domain->domain(), inference));
}

}  // namespace

void bind_inference(py::module_& module) {
  module.def("infer", &infer, py::arg("text"), py::arg("name"), py::arg("files"), py::arg("policy"),
             "The domain with weights that explain a policy, and how well they do; see kith.explain_policy.");
}

}  // namespace kith::python
