// Fitting a study's free parameters to published figures.
#include <nlohmann/json.hpp>

#include "assignment.hpp"
#include "errors.hpp"
#include "kith/present/json.hpp"
#include "kith/study_design/calibration.hpp"
#include "own_kinds.hpp"
#include "waiting.hpp"

namespace kith::python {
namespace {

Json document_of(const TargetSet& set, const Calibration& result) {
  Json parameters = Json::array(), targets = Json::array();
  for (std::size_t k = 0; k < set.parameters.size(); ++k) {
    const auto& range = result.ranges[k];
    parameters.push_back({{"name", set.parameters[k].name},
                          {"keys", set.parameters[k].keys},
                          {"study", set.parameters[k].present},
                          {"calibrated", result.best.values[k]},
                          {"low", range.low},
                          {"high", range.high},
                          {"open_low", range.open_low},
                          {"open_high", range.open_high}});
  }
  for (std::size_t t = 0; t < set.targets.size(); ++t) {
    const auto& outcome = result.best.targets[t];
    targets.push_back({{"target", to_string(set.targets[t])},
                       {"published", set.targets[t].value},
                       {"model", outcome.model},
                       {"standard_error", outcome.standard_error},
                       {"misfit", outcome.misfit},
                       {"miss", outcome.miss}});
  }
  return {{"parameters", parameters},
          {"targets", targets},
          {"settings", overrides_of(set.parameters, result.best.values)},
          {"discrepancy", result.discrepancy},
          {"least_misfit", result.least_misfit},
          {"degrees_of_freedom", result.degrees_of_freedom},
          {"misfit_p", result.misfit_p ? Json(*result.misfit_p) : Json{}},
          {"teams_simulated", result.teams_simulated}};
}

std::string calibrated(const std::string& name, const std::string& text, const std::vector<std::string>& overrides,
                       const std::string& targets, const std::string& targets_name, std::size_t rounds,
                       std::size_t points, std::size_t teams, std::size_t confirm_teams, std::uint64_t seed,
                       std::size_t threads, const py::object& on_progress) {
  constexpr std::size_t kMost = 100'000;
  if (rounds < 1 || rounds > 100 || points < 8 || points > kMost || teams < 2 || teams > kMost || confirm_teams < 2 ||
      confirm_teams > kMost) {
    throw py::value_error{"rounds must be 1 to 100, points 8 or more, and teams 2 or more"};
  }
  const OwnKinds own;
  const auto reading = read_study({name, text, overrides}, own.kinds());
  if (reading.study->variants.size() > 1) throw py::value_error{"the study varies parameters; remove design.vary"};
  const StudyMaker make = [&](const std::vector<std::string>& more) {
    StudyReadOptions options{.overrides = overrides, .folder = {}, .kinds = own.kinds(), .override_name = "settings"};
    options.overrides.insert(options.overrides.end(), more.begin(), more.end());
    return text.empty() ? load_study(name, options) : parse_study(text, name, options);
  };
  Watch watch;
  return wait_for(watch, on_progress, [&] {
    const auto set = parse_targets(targets, targets_name, make);
    if (!set.targets) throw Error{set.diagnostics};
    if (set.targets->targets.empty() || set.targets->parameters.empty()) {
      throw Error{
          {Diagnostic{.id = "E0811",
                      .message = set.targets->targets.empty() ? "there is no [[target]]" : "there is no [[parameter]]",
                      .file = targets_name}}};
    }
    CalibrationOptions options;
    options.rounds = rounds;
    options.points = points;
    options.teams = teams;
    options.confirm_teams = confirm_teams;
    options.frontier_points = 0;
    options.seed = seed;
    options.threads = threads;
    options.on_progress = [&](std::size_t done, std::size_t total) {
      watch.tell(done, total);
      return !watch.stop;
    };
    const Atlas atlas{*reading.domain};
    const auto result = calibrate(atlas, make, *set.targets, options);
    if (!result) throw Stopped{};
    return document_of(*set.targets, *result).dump();
  });
}

}  // namespace

void bind_calibration(py::module_& module) {
  module.def("calibrate", &calibrated, py::arg("name"), py::arg("text"), py::arg("overrides"), py::arg("targets"),
             py::arg("targets_name"), py::arg("rounds"), py::arg("points"), py::arg("teams"), py::arg("confirm_teams"),
             py::arg("seed"), py::arg("threads"), py::arg("on_progress"));
}

}  // namespace kith::python
