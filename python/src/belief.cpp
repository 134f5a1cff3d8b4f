#include "belief.hpp"

#include "arrays.hpp"

namespace kith::python {
namespace {

LikelihoodForm form_of(const std::string& form) {
  if (form == "discontinuous") return LikelihoodForm::kDiscontinuous;
  if (form == "continuous") return LikelihoodForm::kContinuous;
  throw py::value_error{"form must be 'discontinuous' or 'continuous', not '" + form + "'"};
}

HalfSpaceLikelihood likelihood_of(const Belief& belief, double ability, const std::string& form) {
  return HalfSpaceLikelihood{ability, form_of(form), belief.value->dimension()};
}

Belief make(const Cone& prior, std::size_t particles, double process_noise, double resample_below, std::uint64_t seed) {
  constexpr std::size_t kMost = 10'000'000;
  if (particles < 1 || particles > kMost) throw py::value_error{"particles must be 1 to 10 million"};
  const FilterOptions options{.particles = particles, .process_noise = process_noise, .resample_below = resample_below};
  return {std::make_shared<const ParticleBelief>(prior, options), RandomStream{seed}, 0};
}

// Axis by axis in memory, so a column of the array is contiguous.
py::object points(const Belief& self) {
  const auto& belief = *self.value;
  const auto size = static_cast<py::ssize_t>(belief.size());
  constexpr py::ssize_t kSize = sizeof(double);
  return as_array(Array{self.value,
                        belief.axis(0).data(),
                        'd',
                        {size, static_cast<py::ssize_t>(belief.dimension())},
                        {kSize, kSize * size}});
}

py::object weights(const Belief& self) {
  return as_array(Array{
      self.value, self.value->weights().data(), 'd', {static_cast<py::ssize_t>(self.value->size())}, {sizeof(double)}});
}

template <typename Update>
void update(Belief& self, Update change) {
  auto next = std::make_shared<ParticleBelief>(*self.value);
  change(*next, self.random.split(self.updates + 1));
  self.value = std::move(next);
  ++self.updates;
}

void observe(Belief& self, const py::object& half_spaces, double ability, const std::string& form) {
  const auto list = half_spaces_of(half_spaces, self.value->dimension());
  const auto likelihood = likelihood_of(self, ability, form);
  update(self, [&](ParticleBelief& next, const RandomStream& random) { next.observe(list, likelihood, random); });
}

void observe_any(Belief& self, const py::sequence& alternatives, double ability, const std::string& form) {
  std::vector<std::vector<HalfSpace>> lists;
  for (const auto& alternative : alternatives) lists.push_back(half_spaces_of(alternative, self.value->dimension()));
  const auto likelihood = likelihood_of(self, ability, form);
  update(self, [&](ParticleBelief& next, const RandomStream& random) { next.observe_any(lists, likelihood, random); });
}

}  // namespace

void bind_belief(py::module_& module) {
  py::class_<Belief>(module, "ParticleBelief",
                     "A belief about the reward weights: M weighted points of the unit sphere.\n\n"
                     "Arrays that it gives look at its memory and cannot be written. An update makes new memory, so\n"
                     "they stay as they are. Equal seeds and updates give equal beliefs, bit for bit.")
      .def(py::init(&make), py::arg("prior"), py::arg("particles") = 1000, py::kw_only(),
           py::arg("process_noise") = 0.1, py::arg("resample_below") = 0.5, py::arg("seed") = 0,
           "Evenly over the prior, a Cone.\n\n"
           "process_noise: bandwidth factor of the kernel after resampling, >= 0; resample_below: in [0, 1].")
      .def("__len__", [](const Belief& self) { return self.value->size(); })
      .def_property_readonly(
          "dimension", [](const Belief& self) { return self.value->dimension(); }, "d.")
      .def_property_readonly("points", &points, "Shape [M, d], of length 1; shares memory.")
      .def_property_readonly("weights", &weights, "Shape [M], they sum to 1; shares memory.")
      .def_property_readonly(
          "mean", [](const Belief& self) { return to_tuple(self.value->mean_direction()); },
          "The mean direction, of length 1.")
      .def_property_readonly(
          "spread", [](const Belief& self) { return self.value->spread(); },
          "Root mean square distance to the mean, radians.")
      .def_property_readonly(
          "effective_sample_size", [](const Belief& self) { return self.value->effective_sample_size(); },
          "1 / sum of squared weights, in [1, M].")
      .def("observe", &observe, py::arg("half_spaces"), py::arg("ability") = 0.8, py::arg("form") = "discontinuous",
           "Bayes' rule for somebody who draws the right conclusion with this probability, in [0.5, 1].\n\n"
           "kith.Error if no point remains possible; the belief is then as before.")
      .def("observe_any", &observe_any, py::arg("alternatives"), py::arg("ability") = 0.8,
           py::arg("form") = "discontinuous", "The same where any of several lists of half-spaces is enough.")
      .def(
          "diffuse",
          [](Belief& self, double angle) {
            if (!(angle >= 0.0) || angle > 1e6) throw py::value_error{"angle must be 0 or more, in radians"};
            update(self, [&](ParticleBelief& next, const RandomStream& random) { next.diffuse(angle, random); });
          },
          py::arg("angle"), "Moves every point by chance; angle in radians.")
      .def(
          "mass_in",
          [](const Belief& self, const py::object& region) {
            if (py::isinstance<Cone>(region)) {
              const auto& cone = region.cast<const Cone&>();
              if (cone.dimension() != self.value->dimension())
                throw py::value_error{"the region has another dimension than the belief"};
              return self.value->mass_in(cone.minimal_set());
            }
            return self.value->mass_in(half_spaces_of(region, self.value->dimension()));
          },
          py::arg("region"), "Sum of the weights inside a Cone, or of those that satisfy all half-spaces.")
      .def(
          "copy", [](const Belief& self) { return self; }, "A belief that goes on independently.")
      .def("__copy__", [](const Belief& self) { return self; })
      .def(
          "__deepcopy__", [](const Belief& self, const py::dict&) { return self; }, py::arg("memo"))
      .def("__eq__", [](const Belief& self, const Belief& other) { return *self.value == *other.value; })
      .def("__eq__", [](const Belief&, const py::object&) { return false; })
      .def("__repr__", [](const Belief& self) {
        return "<ParticleBelief of " + std::to_string(self.value->size()) + " points in " +
               std::to_string(self.value->dimension()) + " dimensions>";
      });
}

}  // namespace kith::python
