#include "domain.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string_view>

#include "arrays.hpp"
#include "errors.hpp"
#include "kith/bec/memory_needs.hpp"
#include "kith/explain/board_svg.hpp"
#include "kith/explain/inspect_json.hpp"
#include "kith/explain/region_svg.hpp"
#include "kith/explain/words.hpp"
#include "waiting.hpp"

namespace kith::python {
namespace {

DomainPointer domain_from(std::string text, const std::string& name, const DomainFiles& files) {
  auto reading = parse_domain(text, name, {}, files);
  if (!reading.domain) throw Error{reading.diagnostics};
  warn(reading.diagnostics);
  return std::make_shared<LoadedDomain>(*std::move(reading.domain), std::move(text), std::move(reading.files));
}

DomainPointer load(const std::string& name) {
  for (const auto& domain : built_in_domains()) {
    if (domain.name == name) return domain_from(std::string{domain.text}, name, {{}, domain.files});
  }
  std::error_code failure;
  if (!std::filesystem::is_regular_file(name, failure)) (void)load_domain(name);  // says what is wrong
  std::ifstream file{name, std::ios::binary};
  if (!file) throw Error{ErrorKind::kIo, "cannot read " + name};
  return domain_from({std::istreambuf_iterator<char>{file}, {}}, name, {std::filesystem::path{name}.parent_path(), {}});
}

DomainPointer from_text(const std::string& text, const std::string& name, const py::dict& files,
                        const std::string& folder) {
  DomainFiles named{folder, {}};
  for (const auto& [file, content] : files)
    named.known.push_back({file.cast<std::string>(), content.cast<std::string>()});
  return domain_from(text, name, named);
}

MdpIndex world_of(const Domain& domain, std::size_t world) {
  if (world >= domain.num_mdps())
    throw py::index_error{"there is no world " + std::to_string(world) + ", only 0 to " +
                          std::to_string(domain.num_mdps() - 1)};
  return MdpIndex{world};
}

// The number that a model of so many states calls a state by, as in "12" or "12 (end)"; nothing if it calls it
// otherwise.
std::optional<std::size_t> number_in(const std::string& key, std::size_t num_states) {
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), number);
  const std::string_view rest{end, static_cast<std::size_t>(key.data() + key.size() - end)};
  const bool is_plain = static_cast<std::size_t>(end - key.data()) == std::to_string(number).size();  // not "01"
  if (error != std::errc{} || number >= num_states || !is_plain || !(rest.empty() || rest == " (end)"))
    return std::nullopt;
  return number;
}

// A value per state, by number; `other` for numbers whose state is left out.
template <typename ValueOf>
py::list by_number(const Domain& domain, MdpIndex m, std::size_t count, const py::object& other, ValueOf value) {
  std::vector<py::object> values;
  const auto& keys = domain.model_keys();
  for (const auto& key : keys) {
    const auto number = number_in(key, keys.size());
    if (domain.num_mdps() == 1 && keys.front() == "0" && number && *number >= values.size())
      values.resize(*number + 1, other);
  }
  for (std::size_t s = 0; s < count; ++s) {
    const auto number = state_number(domain, m, StateIndex{s});
    if (number >= values.size()) values.resize(number + 1, other);
    if (values[number].is(other)) values[number] = value(StateIndex{s});  // states come before ends of the same number
  }
  py::list list;
  for (auto& one : values) list.append(std::move(one));
  return list;
}

// Actions of the robot by state.
py::list policy(LoadedDomain& self, std::size_t world) {
  const auto atlas = self.atlas();
  const auto m = world_of(self.domain(), world);
  const auto& mdp = self.domain().mdp(m);
  const bool is_map = self.domain().model_keys().empty();  // whose ends come last and are no cells to act in
  const auto count = is_map ? mdp.num_states() : mdp.num_states() + mdp.num_terminals();
  return by_number(self.domain(), m, count, py::none(), [&](StateIndex s) -> py::object {
    if (s.value() >= mdp.num_states()) return py::none();
    return py::str(self.domain().action_names()[atlas->action(atlas->index({m, s})).value()]);
  });
}

py::dict path_to_python(const Domain& domain, MdpIndex m, const Trajectory& path, const IntegerVector& counts) {
  py::list states, actions;
  for (const auto state : path.states) states.append(state_number(domain, m, state));
  for (const auto action : path.actions) actions.append(domain.action_names()[action.value()]);
  py::dict result;
  result["world"] = m.value();
  result["states"] = states;
  result["actions"] = actions;
  result["counts"] = counts_to_tuple(domain, counts);
  result["value"] = return_of(domain, counts);
  result["repeats_from"] = path.repeats_from ? py::object{py::int_(*path.repeats_from)} : py::none();
  return result;
}

// What somebody does from a start, and how it ends; None if they have no optimum there.
py::object path(LoadedDomain& self, const py::object& start, const py::object& weights) {
  const auto start_index = weights.is_none() ? self.state_of(start) : self.candidate_of(start);
  const auto atlas = self.atlas();
  const auto m = atlas->id(start_index).mdp;
  if (weights.is_none())
    return path_to_python(self.domain(), m, atlas->trajectory(start_index), atlas->feature_counts(start_index));
  const auto direction = direction_of(weights, self.domain().num_features(), "weights");
  const auto cache = self.borrow();
  const auto way = cache->behaviours().trajectory(start_index, direction);
  const auto counts = cache->behaviours().answer(start_index, cache->behaviours().locate(direction));
  if (!way || !counts) return py::none();
  return path_to_python(self.domain(), m, *way, *counts);
}

py::list components(LoadedDomain& self) {
  const auto atlas = self.atlas();
  py::list list;
  for (const auto& component : atlas->knowledge_components()) {
    py::list features;
    for (const auto k : component.features) features.append(self.domain().feature_names()[k]);
    py::list worlds;
    for (std::size_t m = 0; m < component.uses_mdp.size(); ++m) {
      if (component.uses_mdp[m]) worlds.append(m);
    }
    py::dict one;
    one["name"] = component.name;
    one["features"] = features;
    one["half_spaces"] = to_list(atlas->constraints().half_spaces(component.constraints));
    one["area_sr"] = component.area_sr;
    one["worlds"] = worlds;
    list.append(one);
  }
  return list;
}

Cone region(LoadedDomain& self) {
  const auto atlas = self.atlas();
  auto cone = atlas->prior_cone();
  if (!cone.clip(atlas->policy_bec_half_spaces()))
    throw Error{ErrorKind::kInfeasible, "the weights under which the robot's policy is optimal have no interior"};
  return cone;
}

Cone prior(const LoadedDomain& self) {
  Cone cone{self.domain().num_features()};
  if (!cone.clip(self.domain().prior())) throw Error{ErrorKind::kInfeasible, "the prior has no interior"};
  return cone;
}

std::string described(LoadedDomain& self, bool demonstrations) {
  const auto atlas = self.atlas();
  return inspection_json(*atlas, {.demos = demonstrations, .mdp = std::nullopt}).dump();
}

// The board of a state with the robot's path, as an SVG file; empty without a map or a picture.
std::string board(LoadedDomain& self, const py::object& start, bool with_path) {
  const auto start_index = self.state_of(start);
  const auto atlas = self.atlas();
  const auto map = self.domain().drawing();
  if (!map) return "";
  const auto id = atlas->id(start_index);
  const BoardSvg drawer{*map};
  Svg svg = drawer.board(id.mdp, map->state(id.mdp, id.start));
  if (with_path) svg.add(0, 0, drawer.path(id.mdp, atlas->trajectory(start_index), "#1f5fbf"));
  return svg.file(drawer.width(), drawer.height(), self.domain().state_name(id.mdp, id.start));
}

std::string region_picture(LoadedDomain& self) {
  const auto atlas = self.atlas();
  const auto cone = region(self);
  std::vector<std::string> captions;
  for (const auto& facet : cone.facets()) captions.push_back(described(self.domain(), facet));
  const auto drawn =
      region_svg({self.domain().feature_names(), atlas->prior_cone(), cone, self.domain().weights().integer, captions});
  return drawn.svg.file(drawn.width, drawn.height, "what is left of the reward weights");
}

py::list words(const LoadedDomain& self, const py::object& half_spaces) {
  py::list list;
  for (const auto& text : all_in_words(self.domain(), half_spaces_of(half_spaces, self.domain().num_features())))
    list.append(text);
  return list;
}

}  // namespace

std::shared_ptr<const Atlas> LoadedDomain::atlas() {
  {
    const py::gil_scoped_release unlocked;
    const std::lock_guard lock{mutex_};
    if (atlas_) return atlas_;
  }
  return wait_for([self = shared_from_this()] {
    const std::lock_guard lock{self->mutex_};
    if (!self->atlas_) {
      require_planning_memory(self->domain_);
      self->atlas_ = std::make_shared<const Atlas>(self->domain_);
    }
    return self->atlas_;
  });
}

LoadedDomain::Loan::Loan(std::shared_ptr<LoadedDomain> domain) : domain_{std::move(domain)} {
  const py::gil_scoped_release unlocked;
  const std::lock_guard lock{domain_->mutex_};
  if (domain_->free_.empty()) {
    cache_ = std::make_unique<TeachingCache>(domain_->atlas_);
  } else {
    cache_ = std::move(domain_->free_.back());
    domain_->free_.pop_back();
  }
}

LoadedDomain::Loan::~Loan() {
  constexpr std::size_t kMostFree = 8;
  const std::lock_guard lock{domain_->mutex_};  // short: nobody computes with it but atlas(), which is done
  if (domain_->free_.size() < kMostFree) domain_->free_.push_back(std::move(cache_));
}

StartIndex LoadedDomain::state_of(const py::handle& start) {
  const auto numbers = integers_of(start, 2, "a start (world, state)");
  if (numbers[0] < 0 || numbers[1] < 0) throw py::index_error{"a start is (world, state), both counted from 0"};
  const auto m = world_of(domain_, static_cast<std::size_t>(numbers[0]));
  const auto s = state_with_number(domain_, m, static_cast<std::size_t>(numbers[1]));
  if (!s)
    throw py::index_error{"world " + std::to_string(m.value()) + " has no state " + std::to_string(numbers[1]) +
                          " in which the robot acts"};
  return atlas()->index({m, *s});
}

std::size_t state_number(const Domain& domain, MdpIndex m, StateIndex s) {
  const auto& keys = domain.model_keys();
  if (keys.empty() || keys.front() != "0") return s.value();
  return number_in(domain.state_key(m, s), keys.size()).value_or(keys.size() + s.value());
}

std::optional<StateIndex> state_with_number(const Domain& domain, MdpIndex m, std::size_t number) {
  for (std::size_t s = 0; s < domain.mdp(m).num_states(); ++s) {
    if (state_number(domain, m, StateIndex{s}) == number) return StateIndex{s};
  }
  return std::nullopt;
}

StartIndex LoadedDomain::candidate_of(const py::handle& start) {
  const auto start_index = state_of(start);
  if (!atlas()->is_candidate(start_index)) throw py::value_error{"this domain lets nothing start in that state"};
  return start_index;
}

py::tuple LoadedDomain::start_of(const Atlas& atlas, StartIndex start) {
  const auto id = atlas.id(start);
  return py::make_tuple(id.mdp.value(), state_number(atlas.domain(), id.mdp, id.start));
}

void bind_domain(py::module_& module) {
  py::class_<LoadedDomain, DomainPointer>(module, "Domain", "A robot in one or several worlds; see kith.Domain.")
      .def(py::init(&load), py::arg("name_or_path"))
      .def_static("from_text", &from_text, py::arg("text"), py::arg("name"), py::arg("files") = py::dict{},
                  py::arg("folder") = "")
      .def_static("built_in",
                  [] {
                    py::list names;
                    for (const auto& domain : built_in_domains()) names.append(domain.name);
                    return names;
                  })
      .def_property_readonly("id", [](const LoadedDomain& self) { return self.domain().id(); })
      .def_property_readonly("title", [](const LoadedDomain& self) { return self.domain().title(); })
      .def_property_readonly("text", &LoadedDomain::text)
      .def_property_readonly("files",
                             [](const LoadedDomain& self) {
                               py::dict files;
                               for (const auto& file : self.files()) files[py::str(file.name)] = file.text;
                               return files;
                             })
      .def_property_readonly("feature_names",
                             [](const LoadedDomain& self) {
                               return py::tuple(py::cast(std::vector<std::string>{self.domain().feature_names()},
                                                         py::return_value_policy::move));
                             })
      .def_property_readonly("action_names",
                             [](const LoadedDomain& self) {
                               return py::tuple(py::cast(std::vector<std::string>{self.domain().action_names()},
                                                         py::return_value_policy::move));
                             })
      .def_property_readonly(
          "weights",
          [](const LoadedDomain& self) {
            return py::tuple(py::cast(std::vector<double>{self.domain().weights().raw}, py::return_value_policy::move));
          })
      .def_property_readonly("num_worlds", [](const LoadedDomain& self) { return self.domain().num_mdps(); })
      .def_property_readonly("num_starts", [](const LoadedDomain& self) { return self.domain().num_starts(); })
      .def_property_readonly("prior", &prior)
      .def_property_readonly("region", &region)
      .def_property_readonly("components", &components)
      .def(
          "world_name",
          [](const LoadedDomain& self, std::size_t world) {
            return self.domain().describe_world(world_of(self.domain(), world));
          },
          py::arg("world"))
      .def(
          "state_names",
          [](const LoadedDomain& self, std::size_t world) {
            const auto m = world_of(self.domain(), world);
            const auto& mdp = self.domain().mdp(m);
            return by_number(self.domain(), m, mdp.num_states() + mdp.num_terminals(), py::str(""),
                             [&](StateIndex s) { return py::str(self.domain().state_name(m, s)); });
          },
          py::arg("world"))
      .def(
          "starts",
          [](const LoadedDomain& self, std::size_t world) {
            py::list states;
            const auto m = world_of(self.domain(), world);
            for (const auto s : self.domain().starts(m)) states.append(state_number(self.domain(), m, s));
            return states;
          },
          py::arg("world"))
      .def(
          "state_number",
          [](const LoadedDomain& self, std::size_t world, std::size_t state) {
            return state_number(self.domain(), world_of(self.domain(), world), StateIndex{state});
          },
          py::arg("world"), py::arg("state"))
      .def(
          "initial",
          [](const LoadedDomain& self, std::size_t world) {
            const auto m = world_of(self.domain(), world);
            return state_number(self.domain(), m, self.domain().initial_state(m));
          },
          py::arg("world"))
      .def(
          "map",
          [](const LoadedDomain& self, std::size_t world) {
            const auto m = world_of(self.domain(), world);
            const auto map = self.domain().drawing();
            py::list rows;
            if (!map) return rows;
            for (const auto& row : map->draw(m, std::nullopt)) rows.append(row);
            return rows;
          },
          py::arg("world"))
      .def("policy", &policy, py::arg("world"))
      .def("path", &path, py::arg("start"), py::arg("weights") = py::none())
      .def("board", &board, py::arg("start"), py::arg("path") = false)
      .def("region_picture", &region_picture)
      .def("words", &words, py::arg("half_spaces"))
      .def("described", &described, py::arg("demonstrations") = false);
}

}  // namespace kith::python
