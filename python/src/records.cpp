#include "records.hpp"

#include "arrays.hpp"
#include "domain.hpp"
#include "kith/domains/file_units.hpp"

namespace kith::python {
namespace {

py::object record(const char* name) { return py::module_::import("kith._records").attr(name); }

std::string source_name(const SourceBelief& source) {
  return source.is_member() ? "member " + std::to_string(source.member + 1) : source.rule;
}

py::list actions_of(const Atlas& atlas, StartIndex start) {
  py::list actions;
  for (const auto action : atlas.trajectory(start).actions)
    actions.append(atlas.domain().action_names()[action.value()]);
  return actions;
}

template <typename Flags>
py::list flags(const Flags& values) {
  py::list list;
  for (const bool value : values) list.append(value);
  return list;
}

template <typename Numbers>
py::list numbers(const Numbers& values) {
  py::list list;
  for (const auto value : values) list.append(value);
  return list;
}

}  // namespace

py::object to_python(const Atlas& atlas, const Lesson& lesson) {
  const auto& domain = atlas.domain();
  py::list demonstrations, tests;
  for (const auto& shown : lesson.demonstrations) {
    demonstrations.append(record("Demonstration")(
        LoadedDomain::start_of(atlas, shown.start), actions_of(atlas, shown.start),
        counts_to_tuple(domain, atlas.feature_counts(shown.start)), to_list(shown.half_spaces), shown.gain));
  }
  for (const auto& test : lesson.tests) {
    tests.append(record("Test")(LoadedDomain::start_of(atlas, test.start), actions_of(atlas, test.start),
                                counts_to_tuple(domain, atlas.feature_counts(test.start)), to_list(test.covered),
                                test.exact));
  }
  return record("Lesson")(lesson.period, lesson.component, atlas.knowledge_components()[lesson.component].name,
                          source_name(lesson.source), demonstrations, tests, to_list(lesson.taught), lesson.repeats,
                          lesson.area_sr, lesson.gain);
}

py::object to_python(const Atlas& atlas, const Feedback& feedback) {
  py::list verdicts;
  for (const auto& member : feedback.verdicts) {
    py::list list;
    for (const auto& verdict : member)
      list.append(record("Verdict")(verdict.correct, in_file_units(atlas.domain().weights(), verdict.regret),
                                    verdict.answered, to_list(verdict.half_spaces)));
    verdicts.append(list);
  }
  return record("Feedback")(verdicts, flags(feedback.all_correct), to_list(feedback.half_spaces),
                            numbers(feedback.excluded), feedback.component_learned, numbers(feedback.released));
}

py::object to_python(const Atlas& atlas, const PastPeriod& period) {
  py::list answers;
  for (const auto& member : period.answers) {
    py::list list;
    for (const auto& answer : member)
      list.append(answer ? py::object{counts_to_tuple(atlas.domain(), *answer)} : py::none());
    answers.append(list);
  }
  return record("Period")(to_python(atlas, period.lesson), answers, to_python(atlas, period.feedback));
}

Unit picked_unit(TeachingCache& cache, std::span<const HalfSpace> taught_region, std::span<const StartIndex> demos,
                 const ParticleBelief* belief, const SelectionOptions& options, const RandomStream& random) {
  const auto& atlas = cache.atlas();
  auto taught = cache.numbers_of(taught_region);
  Unit unit;
  for (std::size_t i = 0; i < demos.size(); ++i) {
    auto conveyed = cache.numbers_of(atlas.constraints().half_spaces(atlas.one_step(demos[i])));
    if (belief != nullptr) {
      const auto cells = sample_counterfactuals(cache.behaviours(), *belief, options, random.split(i));
      conveyed = cache.regions().minimal(cache.behaviours().conveyed(demos[i], cells));
    }
    const auto effect = cache.regions().effect(taught, conveyed);
    taught = cache.regions().minimal(taught | conveyed);
    Demonstration shown;
    shown.start = demos[i];
    shown.half_spaces = cache.constraints().half_spaces(conveyed);
    shown.gain = effect.gain;
    shown.num_new = effect.num_new;
    unit.demonstrations.push_back(std::move(shown));
  }
  unit.taught_region = cache.constraints().half_spaces(taught);
  return unit;
}

}  // namespace kith::python
