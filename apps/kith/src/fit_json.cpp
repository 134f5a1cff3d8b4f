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

Json to_json(const AccuracyFit& fit) {
  Json document{
      {"schema", kSchema}, {"method", "accuracy"}, {"ability_sd", fit.ability_sd}, {"reliability", fit.reliability}};
  document["people"] = Json::array();
  for (const auto& person : fit.people) {
    document["people"].push_back({{"id", person.id},
                                  {"answered", person.answered},
                                  {"correct", person.correct},
                                  {"ability", person.ability},
                                  {"sd", person.sd},
                                  {"lower", person.lower},
                                  {"upper", person.upper}});
  }
  document["items"] = Json::array();
  for (const auto& item : fit.items) {
    document["items"].push_back(
        {{"id", item.id}, {"answered", item.answered}, {"correct", item.correct}, {"difficulty", item.difficulty}});
  }
  return document;
}

Json to_json(const std::vector<GridSearchGroup>& groups) {
  Json document{{"schema", kSchema}, {"method", "grid"}};
  document["groups"] = Json::array();
  for (const auto& group : groups) {
    document["groups"].push_back({{"name", group.name},
                                  {"people", group.people},
                                  {"points", group.points},
                                  {"kept", group.kept},
                                  {"least_error", group.least_error},
                                  {"best",
                                   {{"ability", group.best.ability},
                                    {"confirm_gain", group.best.confirm_gain},
                                    {"correct_gain", group.best.correct_gain}}},
                                  {"ability_mean", group.ability_mean},
                                  {"ability_sd", group.ability_sd},
                                  {"confirm_gain_scale", group.confirm_scale},
                                  {"correct_gain_scale", group.correct_scale}});
  }
  return document;
}

Json to_json(const KindsReport& report) {
  Json document{{"schema", kSchema}, {"method", "kinds"}};
  document["kinds"] = Json::array();
  for (const auto& kind : report.kinds) {
    document["kinds"].push_back({{"kind", kind.kind},
                                 {"share", kind.share},
                                 {"likeliest_for", kind.described},
                                 {"log_evidence", kind.log_evidence},
                                 {"difference", kind.difference},
                                 {"difference_se", kind.difference_se}});
  }
  document["people"] = Json::array();
  for (const auto& person : report.people) {
    Json kinds = Json::object();
    for (std::size_t k = 0; k < report.kinds.size(); ++k) {
      Json parameters = Json::object();
      for (const auto& parameter : person.parameters[k]) {
        parameters[parameter.name] = {{"mean", parameter.mean}, {"lower", parameter.lower}, {"upper", parameter.upper}};
      }
      kinds[report.kinds[k].kind] = {
          {"log_evidence", person.log_evidence[k]}, {"probability", person.probability[k]}, {"parameters", parameters}};
    }
    document["people"].push_back({{"id", person.id},
                                  {"type", person.type},
                                  {"answered", person.answered},
                                  {"likeliest", report.kinds[person.likeliest].kind},
                                  {"cannot_tell_yet", person.is_unclear},
                                  {"kinds", kinds}});
  }
  return document;
}

Json to_json(const PredictionReport& report) {
  Json document{{"schema", kSchema}, {"method", "predict"}, {"people", report.people}, {"answers", report.answers}};
  document["models"] = Json::array();
  for (const auto& model : report.models) {
    Json bins = Json::array();
    for (const auto& bin : model.calibration) {
      bins.push_back({{"answers", bin.answers}, {"predicted", bin.predicted}, {"right", bin.right}});
    }
    document["models"].push_back({{"model", model.model},
                                  {"log_loss", model.log_loss},
                                  {"log_loss_se", model.log_loss_se},
                                  {"difference", model.difference},
                                  {"difference_se", model.difference_se},
                                  {"auc", model.area},
                                  {"best_for", model.best_for},
                                  {"calibration", bins}});
  }
  return document;
}

}  // namespace kith::cli
