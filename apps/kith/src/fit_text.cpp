#include "fit_output.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace kith::cli {
namespace {

constexpr std::size_t kShown = 30;

std::string interval_text(const FitInterval& interval) {
  const auto lower = interval.lower_open ? std::string{"?"} : fmt::format("{:.3f}", interval.lower);
  const auto upper = interval.upper_open ? std::string{"?"} : fmt::format("{:.3f}", interval.upper);
  return lower + " to " + upper;
}

constexpr const char* kPopulationColumns = "lrrlrlrlrl";
const std::vector<std::string> kPopulationHeader{"type",         "people", "mean ability", "", "sd", "",
                                                 "confirm gain", "",       "correct gain", ""};

std::string populations(const FitReport& report, const Console& console) {
  TextTable table{kPopulationColumns};
  table.add(kPopulationHeader);
  for (const auto& type : report.types) {
    std::vector<std::string> row{type.name, fmt::format("{:.0f}", type.fit.people)};
    for (const auto parameter : {&PopulationParameters::ability_mean, &PopulationParameters::ability_sd,
                                 &PopulationParameters::confirm_scale, &PopulationParameters::correct_scale}) {
      row.push_back(fmt::format("{:.3f}", type.median.*parameter));
      row.push_back(fmt::format("{:.3f} to {:.3f}", type.lower.*parameter, type.upper.*parameter));
    }
    table.add(row);
  }
  return console.bold("Populations") + ": posterior medians, used in the [learner] sections below\n" +
         table.text(console) + console.dim("gains: scale of a half-normal; intervals: 95 % of the posterior") + "\n";
}

std::string maxima(const FitReport& report, const Console& console) {
  TextTable table{kPopulationColumns};
  table.add(kPopulationHeader);
  for (const auto& type : report.types) {
    const auto& p = type.fit.parameters;
    table.add({type.name, fmt::format("{:.0f}", type.fit.people), fmt::format("{:.3f}", p.ability_mean),
               interval_text(type.fit.ability_mean), fmt::format("{:.3f}", p.ability_sd),
               interval_text(type.fit.ability_sd), fmt::format("{:.3f}", p.confirm_scale),
               interval_text(type.fit.confirm_scale), fmt::format("{:.3f}", p.correct_scale),
               interval_text(type.fit.correct_scale)});
  }
  auto text = "\n" + console.bold("Maximum of the likelihood") + ", for comparison\n" + table.text(console) +
              console.dim("95 % intervals by profile likelihood; ?: no limit within the values searched") + "\n";
  for (const auto& type : report.types) {
    for (const auto& sentence : type.at_edge)
      text += "  " + (report.types.size() > 1 ? type.name + ": " : "") + sentence + "\n";
  }
  return text + "  " + report.why_estimates_differ + "\n";
}

std::string what_can_be_told(const FitReport& report, const Console& console) {
  std::string text = "\n" + console.bold("What these data can tell") + "\n";
  for (const auto& type : report.types) {
    for (const auto& sentence : type.identifiability.sentences) {
      text += "  " + (report.types.size() > 1 ? type.name + ": " : "") + sentence + "\n";
    }
  }
  for (const auto& sentence : report.sentences) text += "  " + sentence + "\n";
  return text;
}

std::string posterior_text(const ParameterPosterior& posterior) {
  return fmt::format("{:.3f} ({:.3f} to {:.3f})", posterior.mean, posterior.lower, posterior.upper);
}

std::string type_text(const PersonReport& person) {
  if (person.type_probabilities.empty()) return person.type.empty() ? "-" : person.type;
  const auto likeliest = std::max_element(person.type_probabilities.begin(), person.type_probabilities.end());
  const auto number = likeliest - person.type_probabilities.begin() + 1;
  return fmt::format("{} ({:.2f}){}", number, *likeliest, person.type_unclear ? " cannot tell yet" : "");
}

std::string people(const FitReport& report, const Console& console) {
  TextTable table{"llrlll"};
  table.add({"person", "type", "right", "ability", "confirm gain", "correct gain"});
  for (std::size_t i = 0; i < std::min(report.people.size(), kShown); ++i) {
    const auto& person = report.people[i];
    table.add({person.id, type_text(person), fmt::format("{}/{}", person.correct, person.answered),
               posterior_text(person.posterior.ability), posterior_text(person.posterior.confirm_gain),
               posterior_text(person.posterior.correct_gain)});
  }
  auto text = "\n" + console.bold("People") + " (means and 95 % intervals)\n" + table.text(console);
  if (report.people.size() > kShown) {
    text +=
        console.dim(fmt::format("... and {} more; all of them are in the JSON", report.people.size() - kShown)) + "\n";
  }
  return text;
}

std::string recovery_text(const std::vector<ParameterRecovery>& recovered, const Console& console) {
  if (recovered.empty()) return "";
  TextTable table{"lrrrrr"};
  table.add({"parameter", "true mean", "estimated", "error", "se", "held"});
  for (const auto& one : recovered) {
    table.add({one.name, fmt::format("{:.3f}", one.truth), fmt::format("{:.3f}", one.estimate),
               fmt::format("{:+.3f}", one.error), fmt::format("{:.3f}", one.error_se),
               fmt::format("{} of {}", one.held, one.people)});
  }
  return "\n" + console.bold("Recovery") + ": these people are simulated, so the truth is known\n" +
         table.text(console) +
         console.dim(
             "error: of people's posterior means, with its standard error over people, which has no part of "
             "what\nthey share (the population's estimates); held: true values within the 95 % interval") +
         "\n";
}

std::string models(const FitReport& report, const Console& console) {
  if (report.cross_validation.empty()) return "";
  TextTable table{"lrrr"};
  table.add({"model", "log density", "difference", "se"});
  for (const auto& model : report.cross_validation) {
    table.add({model.model, fmt::format("{:.1f}", model.log_density), fmt::format("{:.1f}", model.difference),
               fmt::format("{:.1f}", model.difference_se)});
  }
  return "\n" + console.bold("Models, by people who were held out") + "\n" + table.text(console);
}

// A letter for the type: its label if that is one.
char letter_of(const TypeReport& type, std::size_t k) {
  const bool letter = type.name.size() == 1 &&
                      ((type.name[0] >= 'A' && type.name[0] <= 'Z') || (type.name[0] >= 'a' && type.name[0] <= 'z'));
  return letter ? type.name[0] : static_cast<char>('A' + static_cast<char>(k));
}

}  // namespace

std::string text_of(const FitReport& report, const std::vector<ParameterRecovery>& recovered, const Console& console) {
  auto text = populations(report, console) + maxima(report, console) + what_can_be_told(report, console) +
              models(report, console) + recovery_text(recovered, console) + people(report, console);
  text += "\n" + console.bold("For a study file") + "\n";
  for (std::size_t k = 0; k < report.types.size(); ++k) {
    text += (k == 0 ? "" : "\n") + learner_section(letter_of(report.types[k], k), report.types[k]);
  }
  return text;
}

}  // namespace kith::cli
