#include "design.hpp"

#include <algorithm>
#include <cctype>

#include "kith/core/text.hpp"

namespace kith::detail {
namespace {

std::string settings_text(const std::vector<FactorSetting>& settings) {
  return joined(settings, ", ", [](const FactorSetting& setting) { return setting.key + "=" + setting.value; });
}

// "process noise 0.02, particles 500": for people who see what else varies.
std::string settings_words(const std::vector<FactorSetting>& settings) {
  return joined(settings, ", ", [](const FactorSetting& setting) {
    auto key = setting.key.substr(setting.key.rfind('.') + 1);
    std::replace(key.begin(), key.end(), '_', ' ');
    return key + " " + setting.value;
  });
}

ReportDesign::Series series_of(const RunFiles& run, const TeamAddress& address) {
  const auto settings = settings_text(run.study.variants[address.variant].factors);
  ReportDesign::Series series{address.strategy, label_of(address.strategy), address.strategy, address.variant, {}};
  if (settings.empty()) return series;
  series.code += " [" + settings + "]";
  const auto words = settings_words(run.study.variants[address.variant].factors);
  series.label = run.spec().strategies.size() == 1 ? label_of(words) : series.label + ", " + words;
  return series;
}

}  // namespace

std::string label_of(std::string_view code) {
  std::string label{code};
  std::replace(label.begin(), label.end(), '-', ' ');
  if (!label.empty()) label[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(label[0])));
  return label;
}

ReportDesign design_of(const RunFiles& run) {
  ReportDesign design;
  for (const auto& address : run.teams) {
    const bool same_series = !design.series.empty() && design.series.back().strategy == address.strategy &&
                             design.series.back().variant == address.variant;
    if (!same_series) design.series.push_back(series_of(run, address));
    const bool same_cell = same_series && design.cells.back().composition == address.composition;
    if (!same_cell) design.cells.push_back({design.series.size() - 1, address.composition, 0});
    ++design.cells.back().teams;
    design.cell_of_team.push_back(design.cells.size() - 1);
    for (const char letter : address.composition) ++design.series.back().people[letter];
    design.people += address.composition.size();
  }
  return design;
}

}  // namespace kith::detail
