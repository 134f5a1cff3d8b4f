// Simulated people written in Python.
#include <algorithm>
#include <deque>
#include <type_traits>
#include <utility>

#include "arrays.hpp"
#include "belief.hpp"
#include "domain.hpp"
#include "errors.hpp"
#include "kith/learners/learner_model.hpp"
#include "own_kinds.hpp"
#include "random.hpp"

namespace kith::python {
namespace detail {
namespace {

std::deque<LearnerSlot> learners;  // as own_strategies.cpp keeps its own

constexpr std::size_t kCoverPoints = 1000;

// What a person starts with.
struct Start {
  Belief belief;  ///< Evenly over what people of the type know beforehand.
  RandomStream random{0};
};

template <typename Body>
std::invoke_result_t<Body> calling(const LearnerSlot& slot, Body body) {
  return calling_own_code("the learner '" + slot.name + "'", std::move(body));
}

class OwnLearner final : public Learner {
 public:
  OwnLearner(const LearnerSlot& slot, SharedObject object) : slot_{&slot}, object_{std::move(object)} {}

  [[nodiscard]] std::unique_ptr<Learner> clone() const override {
    return with_object([&](const py::object& object) -> std::unique_ptr<Learner> {
      return std::make_unique<OwnLearner>(*slot_, SharedObject{py::module_::import("copy").attr("deepcopy")(object)});
    });
  }

  void begin_component() override {
    with_object([&](const py::object& object) {
      if (py::hasattr(object, "begin_component")) object.attr("begin_component")();
    });
  }

  void watch(std::span<const HalfSpace> half_spaces, std::size_t period) override {
    with_object([&](const py::object& object) { object.attr("watch")(to_list(half_spaces), period); });
  }

  [[nodiscard]] Response answer(Behaviours& behaviours, std::span<const StartIndex> tests,
                                std::size_t period) const override {
    return with_object([&](const py::object& object) {
      const auto& atlas = behaviours.atlas();
      py::list starts;
      for (const auto test : tests) starts.append(LoadedDomain::start_of(atlas, test));
      const py::object given = object.attr("answer")(starts, period);
      Response response;
      if (is_list_of_answers(given)) {
        for (const auto& answer : given)
          response.answers.push_back(answer.is_none() ? std::nullopt
                                                      : std::optional{counts_of(atlas.domain(), answer)});
        if (response.answers.size() != tests.size())
          throw py::value_error{"answer() gave " + std::to_string(response.answers.size()) + " answers to " +
                                std::to_string(tests.size()) + " tests"};
        return response;
      }
      response.weights = direction_of(given, atlas.domain().num_features(), "the weights of answer()");
      const py::gil_scoped_release unlocked;
      const auto cell = behaviours.locate(*response.weights);
      for (const auto test : tests) response.answers.push_back(behaviours.answer(test, cell));
      return response;
    });
  }

  void hear_feedback(bool all_correct, std::span<const HalfSpace> half_spaces, std::size_t period) override {
    with_object(
        [&](const py::object& object) { object.attr("hear_feedback")(all_correct, to_list(half_spaces), period); });
  }

  [[nodiscard]] std::optional<double> likelihood(const AnswerEvidence&) const override { return std::nullopt; }

  [[nodiscard]] double mass_in(std::span<const HalfSpace> half_spaces) const override {
    return with_object([&](const py::object& object) {
      const double mass = object.attr("mass_in")(to_list(half_spaces)).cast<double>();
      if (!(mass >= 0.0) || mass > 1.0 + 1e-9) throw py::value_error{"mass_in() must give a number in [0, 1]"};
      return std::min(mass, 1.0);
    });
  }

  [[nodiscard]] const ParticleBelief* belief() const override {
    return with_object([&](const py::object& object) -> const ParticleBelief* {
      const py::object belief = py::getattr(object, "belief", py::none());
      if (!py::isinstance<Belief>(belief)) return nullptr;
      belief_ = belief.cast<const Belief&>().value;
      return belief_.get();
    });
  }

 private:
  // A list, empty or whose first entry is no number: answers, not weights.
  static bool is_list_of_answers(const py::object& given) {
    if (!py::isinstance<py::list>(given) && !py::isinstance<py::tuple>(given)) return false;
    const py::sequence list{given};
    return list.size() == 0 || PyNumber_Check(py::object{list[0]}.ptr()) == 0 ||
           PySequence_Check(py::object{list[0]}.ptr()) != 0;
  }

  template <typename Body>
  std::invoke_result_t<Body, const py::object&> with_object(Body body) const {
    const Lock lock;
    return calling(*slot_, [&]() -> std::invoke_result_t<Body, const py::object&> { return body(object_.get()); });
  }

  const LearnerSlot* slot_;
  SharedObject object_;
  mutable std::shared_ptr<const ParticleBelief> belief_;  // the last that belief() gave
};

std::unique_ptr<Learner> make_learner(const LearnerSlot& slot, const LearnerStart& start, const RandomStream& random) {
  const auto& cover = start.cover(kCoverPoints);
  auto belief = std::make_shared<const ParticleBelief>(cover, FilterOptions{.particles = kCoverPoints});
  const Lock lock;
  return calling(slot, [&]() -> std::unique_ptr<Learner> {
    const auto own = py::cast(Start{{std::move(belief), random.split("belief"), 0}, random.split("own")});
    return std::make_unique<OwnLearner>(slot, SharedObject{py::handle{slot.make}(own)});
  });
}

void register_learner(const std::string& name, const std::string& description, const std::string& version,
                      const py::object& make) {
  if (name.empty()) throw py::value_error{"a learner needs a name"};
  if (find_learner_model(name) != nullptr)
    throw py::value_error{"'" + name + "' is a learner of kith; give yours another name"};
  auto at = std::ranges::find(learners, name, &LearnerSlot::name);
  if (at == learners.end()) {
    at = learners.insert(at, {.name = name, .description = description});
    LearnerSlot& slot = *at;
    slot.model.kind = slot.name;
    slot.model.description = slot.description;
    slot.model.draw = [](const ParameterValues&, RandomStream) { return std::vector<double>{}; };
    slot.model.make = [&slot](const ParameterValues&, std::span<const double>, const LearnerStart& start,
                              RandomStream random) { return make_learner(slot, start, random); };
  }
  at->version = version;
  at->make = make.inc_ref().ptr();
}

}  // namespace

std::vector<const LearnerSlot*> own_learners() {
  std::vector<const LearnerSlot*> rows;
  for (const auto& slot : learners) rows.push_back(&slot);
  return rows;
}

void bind_own_learners(py::module_& module) {
  py::class_<Start>(module, "LearnerStart", "What a person starts with.")
      .def_property_readonly(
          "belief", [](const Start& self) { return self.belief; },
          "A ParticleBelief that is even over what people of this type know beforehand.")
      .def_property_readonly(
          "random", [](const Start& self) { return Stream{self.random}; }, "What this person draws from.");
  module.def("register_learner", &register_learner, py::arg("name"), py::arg("description"), py::arg("version"),
             py::arg("make"));
}

}  // namespace detail
}  // namespace kith::python
