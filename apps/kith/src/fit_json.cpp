#include "fit_output.hpp"

#include <nlohmann/json.hpp>

namespace kith::cli {
namespace {

constexpr const char* kSchema = "kith.fit/1";

// An end that the data leave open is null.
Json maximum(double value, const FitInterval& interval) {
  return {{"estimate", value},
          {"lower", interval.lower_open ? Json(nullptr) : Json(interval.lower)},
          {"upper", interval.upper_open ? Json(nullptr) : Json(interval.upper)}};
}

// The headline, and the maximum of the likelihood beside it.
Json parameter(const TypeReport& type, double PopulationParameters::*parameter, const FitInterval& interval) {
  return {{"estimate", type.median.*parameter},
          {"lower", type.lower.*parameter},
          {"upper", type.upper.*parameter},
          {"maximum_likelihood", maximum(type.fit.parameters.*parameter, interval)}};
}

Json parameter(const ParameterPosterior& posterior) {
  return {{"mean", posterior.mean},
          {"sd", posterior.sd},
          {"lower", posterior.lower},
          {"upper", posterior.upper},
          {"contraction", posterior.contraction()}};
}

Json type_to_json(const TypeReport& type) {
  using Parameters = PopulationParameters;
  const auto& known = type.identifiability;
  return {{"name", type.name},
          {"people", type.fit.people},
          {"share", type.share},
          {"log_likelihood", type.fit.log_likelihood},
          {"estimates", "posterior medians"},
          {"ability_mean", parameter(type, &Parameters::ability_mean, type.fit.ability_mean)},
          {"ability_sd", parameter(type, &Parameters::ability_sd, type.fit.ability_sd)},
          {"confirm_gain_scale", parameter(type, &Parameters::confirm_scale, type.fit.confirm_scale)},
          {"correct_gain_scale", parameter(type, &Parameters::correct_scale, type.fit.correct_scale)},
          {"at_edge", type.at_edge},
          {"identifiability",
           {{"gains_apart", known.gains_apart},
            {"gains_statistic", known.gains.statistic},
            {"gains_p", known.gains.p},
            {"contraction",
             {{"ability", known.ability},
              {"confirm_gain", known.confirm_gain},
              {"correct_gain", known.correct_gain},
              {"difference", known.difference}}},
            {"gain_correlation", known.gain_correlation},
            {"sentences", known.sentences}}}};
}

Json person_to_json(const PersonReport& person) {
  Json result{{"id", person.id},
              {"type", person.type.empty() ? Json(nullptr) : Json(person.type)},
              {"periods", person.periods},
              {"answered", person.answered},
              {"correct", person.correct},
              {"ability", parameter(person.posterior.ability)},
              {"confirm_gain", parameter(person.posterior.confirm_gain)},
              {"correct_gain", parameter(person.posterior.correct_gain)},
              {"gain_correlation", person.posterior.gain_correlation}};
  if (!person.type_probabilities.empty()) {
    result["type_probabilities"] = person.type_probabilities;
    result["type_unclear"] = person.type_unclear;
  }
  return result;
}

}  // namespace

Json to_json(const FitReport& report, const std::vector<ParameterRecovery>& recovered,
             const std::vector<Diagnostic>& notes) {
  Json document{{"schema", kSchema}, {"method", "likelihood"}};
  document["types"] = Json::array();
  for (const auto& type : report.types) document["types"].push_back(type_to_json(type));
  document["people"] = Json::array();
  for (const auto& person : report.people) document["people"].push_back(person_to_json(person));
  if (!recovered.empty()) document["recovery"] = Json::array();
  for (const auto& one : recovered) {
    document["recovery"].push_back({{"parameter", one.name},
                                    {"truth", one.truth},
                                    {"estimate", one.estimate},
                                    {"error", one.error},
                                    {"error_se", one.error_se},
                                    {"held", one.held},
                                    {"people", one.people}});
  }
  document["cross_validation"] = Json::array();
  for (const auto& model : report.cross_validation) {
    document["cross_validation"].push_back({{"model", model.model},
                                            {"log_density", model.log_density},
                                            {"difference", model.difference},
                                            {"difference_se", model.difference_se}});
  }
  document["sentences"] = report.sentences;
  document["why_estimates_differ"] = report.why_estimates_differ;
  document["notes"] = Json::array();
  for (const auto& note : notes) document["notes"].push_back(to_json(note));
  return document;
}

}  // namespace kith::cli
