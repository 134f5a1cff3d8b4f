#pragma once

#include "json_table.hpp"
#include "kith/analysis/finding.hpp"
#include "run_data.hpp"

namespace kith::detail {

// What the first screen of a report is made from.
struct FirstScreen {
  const ReportDesign& design;
  const RunData& data;
  const std::vector<Finding>& findings;
  bool simulated = true;  // or real people
  bool paired = false;    // a replicate is the same people under every strategy
  bool by_tests = true;   // whether teaching goes on until all tests are passed
};

// What was found, as one sentence.
[[nodiscard]] std::string headline(const FirstScreen& screen);

// [{"question", "outcome", "means", "compared", "estimate", "low", "high", "bound", "digits", "p", "answer",
// "finding"}]: the questions of the study with the size of each effect and its 95 % interval, or with what any two of
// its levels differ by at most ("bound").
[[nodiscard]] Json answers(const FirstScreen& screen);

// How much strategies and compositions differ from the first of them; null if there is only one of each. {"interval",
// "outcomes": [{"name", "digits"}], "groups": [{"factor", "against", "rows": [{"code", "differences": [{"estimate",
// "low", "high", "n"}]}]}]}.
[[nodiscard]] Json differences(const FirstScreen& screen);

// What the study cannot say, in sentences.
[[nodiscard]] Json limits(const FirstScreen& screen);

// What a strategy does and who a composition is, by code.
[[nodiscard]] Json meanings(const ReportDesign& design, const std::map<char, std::string>& types);

}  // namespace kith::detail
