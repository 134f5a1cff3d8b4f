// Strategies written in Python: a row of the registry, an adapter that calls the Python object, and what that sees of
// a session.
#include <algorithm>
#include <chrono>
#include <deque>
#include <thread>
#include <utility>

#include "arrays.hpp"
#include "belief.hpp"
#include "domain.hpp"
#include "errors.hpp"
#include "kith/teaching/demonstration_selection.hpp"
#include "kith/teaching/strategy.hpp"
#include "kith/teaching/teaching_options.hpp"
#include "own_kinds.hpp"
#include "random.hpp"
#include "records.hpp"

namespace kith::python {
namespace detail {
namespace {

std::deque<StrategySlot> strategies;  // written with the interpreter's lock, before anybody has the row

// A unit of demonstrations, and the belief that it was chosen for.
struct OwnUnit {
  Unit unit;
  SourceBelief source;
};

// The session as a strategy sees it; empty once propose() has returned.
class View {
 public:
  View(const TeachingView& view, UnitSelector& select, const RandomStream& random)
      : view_{&view}, select_{&select}, random_{random} {}
  // A thread that the strategy started may still be choosing.
  void close() {
    while (is_busy_) {
      const py::gil_scoped_release unlocked;
      std::this_thread::sleep_for(std::chrono::milliseconds{1});
    }
    view_ = nullptr;
  }

  [[nodiscard]] const TeachingView& get() const {
    if (view_ == nullptr) throw py::value_error{"a view can be used during propose() only"};
    return *view_;
  }
  [[nodiscard]] const RandomStream& random() const noexcept { return random_; }

  // "joint", a seat, or a belief of the strategy's own.
  [[nodiscard]] std::pair<const ParticleBelief*, SourceBelief> belief_of(const py::object& whose) const {
    if (py::isinstance<Belief>(whose)) {
      const auto& belief = *whose.cast<const Belief&>().value;
      if (belief.dimension() != get().atlas.domain().num_features())
        throw py::value_error{"the belief has another dimension than the domain"};
      return {&belief, SourceBelief::of_everybody()};
    }
    if (py::isinstance<py::str>(whose)) {
      const auto rule = whose.cast<std::string>();
      try {
        return {&get().belief.aggregate(rule), SourceBelief::of_team(rule)};
      } catch (const std::logic_error&) {
        throw py::value_error{"no belief '" + rule + "' is kept; name it in the class's `needs`"};
      }
    }
    const auto seat = py::cast<std::size_t>(whose);
    if (seat >= get().belief.num_members()) throw py::index_error{"there is no such member"};
    try {
      return {&get().belief.member(seat), SourceBelief::of_member(seat)};
    } catch (const std::logic_error&) {
      throw py::value_error{"no beliefs about members are kept; name 'members' in the class's `needs`"};
    }
  }

  OwnUnit select(const py::object& whose) {
    const auto [belief, source] = belief_of(whose);
    const auto kept = *belief;  // the caller's own may be dropped while the lock is released
    const Choosing one_at_a_time{is_busy_};
    const auto random = next_random();
    const py::gil_scoped_release unlocked;
    return {select_->for_belief(kept, random), source};
  }

  OwnUnit pick(const py::iterable& starts, const py::object& whose) {
    std::vector<StartIndex> demos;
    for (const auto& start : starts) demos.push_back(candidate_of(start));
    std::optional<ParticleBelief> belief;
    auto source = SourceBelief::of_everybody();
    if (!whose.is_none()) {
      const auto [found, of] = belief_of(whose);
      belief = *found;
      source = of;
    }
    const auto& view = get();
    const Choosing one_at_a_time{is_busy_};
    const auto random = next_random();
    const py::gil_scoped_release unlocked;
    return {picked_unit(select_->cache(), view.taught_region, demos, belief ? &*belief : nullptr, select_->options(),
                        random),
            source};
  }

  [[nodiscard]] StartIndex candidate_of(const py::handle& start) const {
    const auto& atlas = get().atlas;
    const auto id = integers_of(start, 2, "a start (world, state)");
    if (id[0] < 0 || id[1] < 0 || static_cast<std::size_t>(id[0]) >= atlas.domain().num_mdps())
      throw py::index_error{"there is no such start"};
    const MdpIndex m{static_cast<std::size_t>(id[0])};
    const auto s = state_with_number(atlas.domain(), m, static_cast<std::size_t>(id[1]));
    if (!s || !atlas.is_candidate(atlas.index({m, *s}))) throw py::index_error{"there is no such start"};
    return atlas.index({m, *s});
  }

  [[nodiscard]] py::list candidates() const {
    const auto& atlas = get().atlas;
    const auto& component = atlas.knowledge_components()[get().component];
    py::list starts;
    for (StartIndex start_index{0}; start_index.value() < atlas.num_states(); ++start_index) {
      if (!atlas.is_candidate(start_index) || !component.uses_mdp[atlas.id(start_index).mdp.value()]) continue;
      if (!atlas.one_step(start_index).empty()) starts.append(LoadedDomain::start_of(atlas, start_index));
    }
    return starts;
  }

 private:
  // What chooses is not for several threads at a time.
  struct Choosing {
    explicit Choosing(bool& flag) : is_busy{flag} {
      if (is_busy) throw py::value_error{"another thread is choosing with this view"};
      is_busy = true;
    }
    ~Choosing() { is_busy = false; }
    Choosing(const Choosing&) = delete;
    Choosing& operator=(const Choosing&) = delete;
    bool& is_busy;
  };

  // The first is the strategy's own, as a strategy of the libraries that chooses once has it.
  RandomStream next_random() {
    const auto n = calls_++;
    return n == 0 ? random_ : random_.split("call").split(n);
  }

  const TeachingView* view_;
  UnitSelector* select_;
  RandomStream random_;
  std::uint64_t calls_ = 0;
  bool is_busy_ = false;  // read and written with the interpreter's lock
};

// Makes sure that a view is closed, whatever happens.
struct OpenView {
  explicit OpenView(std::shared_ptr<View> what) : view{std::move(what)} {}
  ~OpenView() { view->close(); }
  OpenView(const OpenView&) = delete;
  OpenView& operator=(const OpenView&) = delete;
  std::shared_ptr<View> view;
};

class OwnStrategy final : public Strategy {
 public:
  OwnStrategy(const StrategySlot& slot, SharedObject object) : slot_{&slot}, object_{std::move(object)} {}

  [[nodiscard]] std::unique_ptr<Strategy> clone() const override {
    const Lock lock;
    return call([&] {
      return std::make_unique<OwnStrategy>(*slot_,
                                           SharedObject{py::module_::import("copy").attr("deepcopy")(object_.get())});
    });
  }

  [[nodiscard]] UnitProposal propose(const TeachingView& view, UnitSelector& select, RandomStream random) override {
    const Lock lock;
    return call([&]() -> UnitProposal {
      const OpenView open{std::make_shared<View>(view, select, random)};
      const py::object chosen = object_.get().attr("propose")(open.view);
      if (chosen.is_none()) return {SourceBelief::of_everybody(), {}};
      if (py::isinstance<OwnUnit>(chosen)) {
        const auto& own = chosen.cast<const OwnUnit&>();
        return {own.source, own.unit};
      }
      const bool names_belief =
          py::isinstance<py::str>(chosen) || py::isinstance<py::int_>(chosen) || py::isinstance<Belief>(chosen);
      auto own = names_belief ? open.view->select(chosen) : open.view->pick(chosen, py::none());
      return {std::move(own.source), std::move(own.unit)};
    });
  }

  template <typename Body>
  std::invoke_result_t<Body> call(Body body) const {
    return calling(*slot_, std::move(body));
  }
  template <typename Body>
  static std::invoke_result_t<Body> calling(const StrategySlot& slot, Body body) {
    return calling_own_code("the strategy '" + slot.name + "'", std::move(body));
  }

 private:
  const StrategySlot* slot_;
  SharedObject object_;
};

StrategyKind kind_of(const StrategySlot& slot) {
  return {slot.name, slot.description, [&slot](const ParameterValues&) { return slot.needs; },
          [&slot](const ParameterValues&) {
            const Lock lock;
            return OwnStrategy::calling(slot, [&]() -> std::unique_ptr<Strategy> {
              return std::make_unique<OwnStrategy>(slot, SharedObject{py::handle{slot.make}()});
            });
          }};
}

TeamBeliefNeeds needs_from(const std::vector<std::string>& names) {
  TeamBeliefNeeds needs;
  for (const auto& name : names) {
    if (name == "members") {
      needs.members = true;
    } else if (find_aggregation_rule(name) != nullptr) {
      needs.rules.push_back(name);
    } else {
      throw py::value_error{"a strategy may need 'members', 'common' and 'joint', not '" + name + "'"};
    }
  }
  return needs;
}

void register_strategy(const std::string& name, const std::string& description, const std::string& version,
                       const std::vector<std::string>& needs, const py::object& make) {
  if (name.empty()) throw py::value_error{"a strategy needs a name"};
  if (find_strategy_kind(name) != nullptr)
    throw py::value_error{"'" + name + "' is a strategy of kith; give yours another name"};
  auto reads = needs_from(needs);
  auto at = std::ranges::find(strategies, name, &StrategySlot::name);
  if (at == strategies.end()) at = strategies.insert(at, {.name = name, .description = description});  // for ever
  StrategySlot& slot = *at;
  slot.needs = std::move(reads);
  slot.version = version;
  slot.make = make.inc_ref().ptr();
}

}  // namespace

std::vector<std::pair<StrategyKind, const StrategySlot*>> own_strategies() {
  std::vector<std::pair<StrategyKind, const StrategySlot*>> rows;
  for (const auto& slot : strategies) rows.emplace_back(kind_of(slot), &slot);
  return rows;
}

void bind_own_strategies(py::module_& module) {
  py::class_<OwnUnit>(module, "Unit", "Demonstrations that are shown together.")
      .def("__len__", [](const OwnUnit& self) { return self.unit.demonstrations.size(); })
      .def_property_readonly(
          "gains",
          [](const OwnUnit& self) {
            std::vector<double> gains;
            for (const auto& shown : self.unit.demonstrations) gains.push_back(shown.gain);
            return gains;
          },
          "Of each demonstration: area of what is left before / after, >= 1.")
      .def_property_readonly(
          "half_spaces",
          [](const OwnUnit& self) {
            py::list list;
            for (const auto& one : self.unit.demonstrations) list.append(to_list(one.half_spaces));
            return list;
          },
          "What each of them conveys: lists of normals.");
  py::class_<View, std::shared_ptr<View>>(module, "View",
                                          "What a strategy sees of a session; valid during propose() only.")
      .def_property_readonly(
          "period", [](const View& self) { return self.get().period; }, "The coming one, from 1.")
      .def_property_readonly(
          "component", [](const View& self) { return self.get().component; }, "What is to be taught, from 0.")
      .def_property_readonly(
          "num_members", [](const View& self) { return self.get().belief.num_members(); }, "Seats.")
      .def_property_readonly(
          "present", [](const View& self) { return self.get().belief.present(); }, "Who takes part, by seat.")
      .def_property_readonly(
          "taught_region", [](const View& self) { return to_list(self.get().taught_region); },
          "What was taught in the components before, with the prior: normals.")
      .def_property_readonly(
          "visited",
          [](const View& self) {
            py::list starts;
            for (const auto start : self.get().visited.in_order())
              starts.append(LoadedDomain::start_of(self.get().atlas, start));
            return starts;
          },
          "Starts that were shown or asked before: (world, state).")
      .def_property_readonly("candidates", &View::candidates, "Starts of the component's worlds: (world, state).")
      .def_property_readonly(
          "history",
          [](const View& self) {
            py::list periods;
            for (const auto& period : self.get().history) periods.append(to_python(self.get().atlas, period));
            return periods;
          },
          "All completed periods.")
      .def_property_readonly(
          "random", [](const View& self) { return Stream{self.random().split("own")}; },
          "What a strategy draws from: the same for the same session and period.")
      .def(
          "belief", [](const View& self, const py::object& whose) { return copy_of(*self.belief_of(whose).first); },
          py::arg("whose"), "A member's belief by seat, or the team's: 'common', 'joint'. Only what `needs` names.")
      .def("select", &View::select, py::arg("belief"),
           "The best unit for a belief by the rule of the paper: a name, a seat or a ParticleBelief.")
      .def("pick", &View::pick, py::arg("starts"), py::arg("belief") = py::none(),
           "The unit of these starts. What they convey is what their paths show or, with a belief, what they tell "
           "people who hold it.")
      .def(
          "mass_in_component",
          [](const View& self, const py::object& whose) {
            const auto& atlas = self.get().atlas;
            const auto& component = atlas.knowledge_components()[self.get().component];
            return self.belief_of(whose).first->mass_in(atlas.constraints().half_spaces(component.constraints));
          },
          py::arg("belief"), "How much of a belief has understood the component, in [0, 1].");
  module.def("register_strategy", &register_strategy, py::arg("name"), py::arg("description"), py::arg("version"),
             py::arg("needs"), py::arg("make"));
}

}  // namespace detail
}  // namespace kith::python
