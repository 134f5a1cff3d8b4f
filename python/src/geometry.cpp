#include <memory>
#include <string>

#include "arrays.hpp"
#include "binding.hpp"
#include "kith/core/distributions.hpp"
#include "kith/geometry/cone.hpp"
#include "kith/geometry/cone_sampler.hpp"
#include "random.hpp"

namespace kith::python {
namespace {

Cone cone_of(const py::object& half_spaces, std::size_t dimension) {
  const auto list = half_spaces_of(half_spaces, dimension);
  if (list.empty() && dimension == 0) throw py::value_error{"without half-spaces the dimension has to be given"};
  Cone cone{list.empty() ? dimension : list.front().dimension()};
  if (!cone.clip(list)) throw py::value_error{"these half-spaces have no interior point in common"};
  return cone;
}

HalfSpace one_half_space(const py::object& object, std::size_t dimension) {
  const auto list = half_spaces_of(object, dimension);
  if (list.size() != 1) throw py::value_error{"half-spaces must be one normal here"};
  return list.front();
}

py::object draw(const Cone& cone, std::size_t n, std::uint64_t seed) {
  constexpr std::size_t kMost = 10'000'000;
  if (n > kMost) throw py::value_error{"n must be at most 10 million"};
  const ConeSampler sampler{cone};
  RandomStream random{seed};
  std::vector<double> points;
  points.reserve(n * cone.dimension());
  for (std::size_t i = 0; i < n; ++i) {
    const auto point = sampler.sample(random);
    points.insert(points.end(), point.begin(), point.end());
  }
  return as_array(std::move(points), {static_cast<py::ssize_t>(n), static_cast<py::ssize_t>(cone.dimension())});
}

py::object cover(const Cone& cone, std::size_t n) {
  constexpr std::size_t kMost = 10'000'000;
  if (n == 0 || n > kMost) throw py::value_error{"n must be 1 to 10 million"};
  const auto columns = std::make_shared<const Eigen::MatrixXd>(ConeSampler{cone}.cover(n));  // a point per column
  const auto d = static_cast<py::ssize_t>(cone.dimension());
  constexpr py::ssize_t kSize = sizeof(double);
  return as_array(Array{columns, columns->data(), 'd', {static_cast<py::ssize_t>(n), d}, {d * kSize, kSize}});
}

std::string text_of(const Cone& cone) {
  std::string text = "Cone(";
  for (const auto& facet : cone.minimal_set()) text += (text.back() == '(' ? "[" : ", ") + to_string(facet.normal());
  text += cone.facets().empty() ? "" : "], ";
  return text + "dimension=" + std::to_string(cone.dimension()) + ")";
}

void bind_stream(py::module_& module) {
  py::class_<Stream>(module, "RandomStream",
                     "A reproducible stream of random numbers, told apart by its address.\n\n"
                     "split(tag) gives a child that depends on this stream's address and the tag only, not on what was "
                     "drawn.")
      .def(py::init([](std::uint64_t seed) { return Stream{RandomStream{seed}}; }), py::arg("seed"))
      .def(
          "split", [](const Stream& self, std::string_view tag) { return Stream{self.stream.split(tag)}; },
          py::arg("tag"), "The child of this name.")
      .def(
          "split", [](const Stream& self, std::uint64_t tag) { return Stream{self.stream.split(tag)}; }, py::arg("tag"),
          "The child of this number.")
      .def(
          "uniform", [](Stream& self) { return uniform01(self.stream); }, "The next number, evenly from [0, 1).")
      .def_property_readonly(
          "address", [](const Stream& self) { return self.stream.address(); },
          "A whole number that identifies the stream: a seed for other generators.")
      .def("__copy__", [](const Stream& self) { return self; })
      .def(
          "__deepcopy__", [](const Stream& self, const py::dict&) { return self; }, py::arg("memo"));
}

}  // namespace

void bind_geometry(py::module_& module) {
  bind_stream(module);
  py::class_<Cone>(module, "Cone",
                   "All reward weights that satisfy some half-spaces normal . w >= 0, in 2 to 8 dimensions; exact.\n\n"
                   "Normals are whole numbers. A cone has interior points; it does not change.")
      .def(py::init(&cone_of), py::arg("half_spaces") = py::tuple{}, py::arg("dimension") = 0,
           "half_spaces: normals, shape [n, d]; none with a dimension: the whole sphere.\n\n"
           "ValueError if nothing inside would be left.")
      .def_property_readonly("dimension", &Cone::dimension, "d, 2 to 8.")
      .def_property_readonly(
          "facets", [](const Cone& self) { return to_list(self.minimal_set()); },
          "The half-spaces that are needed, as normals, sorted.")
      .def_property_readonly(
          "solid_angle", [](const Cone& self) { return self.measure().value; },
          "Area on the unit sphere: steradian for d = 3, radians for d = 2, an estimate beyond 3.")
      .def_property_readonly(
          "generators",
          [](const Cone& self) {
            py::list list;
            for (const auto& generator : self.generators()) list.append(to_tuple(generator));
            return list;
          },
          "Whole vectors whose non-negative combinations are the cone.")
      .def_property_readonly(
          "interior", [](const Cone& self) { return to_tuple(self.interior_direction()); },
          "A whole direction strictly inside.")
      .def(
          "clipped",
          [](const Cone& self, const py::object& half_spaces) -> py::object {
            Cone cone = self;
            if (!cone.clip(half_spaces_of(half_spaces, self.dimension()))) return py::none();
            return py::cast(std::move(cone));
          },
          py::arg("half_spaces"), "What is left of it inside these half-spaces; None if nothing is.")
      .def(
          "implies",
          [](const Cone& self, const py::object& half_space) {
            return self.implies(one_half_space(half_space, self.dimension()));
          },
          py::arg("half_space"), "Whether every point of it satisfies the half-space.")
      .def(
          "contains",
          [](const Cone& self, const py::object& weights) {
            return self.contains(direction_of(weights, self.dimension(), "weights"));
          },
          py::arg("weights"), "Whether these weights, shape [d], are inside or on the boundary.")
      .def("sample", &draw, py::arg("n"), py::arg("seed") = 0,
           "n random points, evenly from its part of the unit sphere, shape [n, d].")
      .def("cover", &cover, py::arg("n"), "n points that cover its part of the unit sphere evenly, shape [n, d].")
      .def("__eq__",
           [](const Cone& self, const Cone& other) { return self.dimension() == other.dimension() && self == other; })
      .def("__eq__", [](const Cone&, const py::object&) { return false; })
      .def("__hash__",
           [](const Cone& self) {
             std::size_t hash = self.dimension();
             for (const auto& facet : self.minimal_set()) hash = hash * 31 + std::hash<HalfSpace>{}(facet);
             return hash;
           })
      .def("__repr__", &text_of);
}

}  // namespace kith::python
