#include "planning_input.hpp"

#include <algorithm>
#include <system_error>

#include "input.hpp"
#include "kith/core/error.hpp"

namespace kith::cli {

StudyText::StudyText(const std::string& name, std::vector<std::string> overrides)
    : name_{name}, overrides_{std::move(overrides)} {
  const auto& known = built_in_studies();
  const auto built_in = std::find_if(known.begin(), known.end(), [&](const auto& one) { return one.name == name; });
  if (built_in != known.end()) {
    text_ = built_in->text;
  } else if (std::error_code failure; name == "-" || std::filesystem::exists(name, failure)) {
    auto input = read_input(name);
    name_ = input.name;
    text_ = std::move(input.text);
    folder_ = input.folder;
  } else {
    (void)study_of(name, {});  // says what is wrong
  }
  const auto reading = read({});
  if (!reading.study) throw Error{reading.diagnostics};
}

StudyReading StudyText::read(const std::vector<std::string>& overrides) const {
  auto all = overrides_;
  all.insert(all.end(), overrides.begin(), overrides.end());
  return parse_study(text_, name_, {all, folder_});
}

void check_single_variant(const std::string& name, const Study& study) {
  if (study.variants.size() == 1 && study.variants.front().factors.empty()) return;
  Diagnostic varies;
  varies.id = "E0812";
  varies.file = name;
  varies.message = "keys vary within this study";
  varies.hint = "remove design.vary";
  throw Error{{varies}};
}

TargetSet targets_of(const std::string& file, const StudyText& study) {
  const auto input = read_input(file);
  auto reading = parse_targets(input.text, input.name, [&](const auto& overrides) { return study.read(overrides); });
  if (!reading.targets) throw Error{reading.diagnostics};
  return *std::move(reading.targets);
}

}  // namespace kith::cli
