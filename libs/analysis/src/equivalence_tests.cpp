#include "equivalence_tests.hpp"

#include <fmt/format.h>

#include <utility>

#include "kith/stats/equivalence.hpp"

namespace kith {

using Kind = ResultKind;

EquivalenceTests::EquivalenceTests(const FixedEffects& model, const AnalysisOptions& options) : options_{options} {
  if (!options.smallest_effect || model.link != Link::kIdentity) return;
  if (options.smallest_effect->standardized && !model.residual_sd) return;
  margin_ = options.smallest_effect->size * (options.smallest_effect->standardized ? *model.residual_sd : 1.0);
}

void EquivalenceTests::add(const std::vector<Comparison>& comparisons) {
  for (const auto& comparison : comparisons) {
    const auto test = test_equivalence(comparison.estimate, {-margin_, margin_}, options_.alpha);
    if (!test) continue;
    const bool is_equivalent = test->p < options_.alpha;
    (is_equivalent ? equivalent_ : others_) += 1;
    rows_.push_back({text_cell(comparison.group.empty() ? comparison.estimate.name
                                                        : comparison.group + ": " + comparison.estimate.name),
                     test->estimate, test->narrow.low, test->narrow.high, test->p,
                     text_cell(std::string{to_string(test->verdict)})});
  }
}

void EquivalenceTests::finish(const std::string& what, Finding& finding, std::vector<ResultTable>& tables) {
  if (rows_.empty()) return;
  const auto level = fmt::format("{:.3g} %", 100.0 * (1.0 - 2.0 * options_.alpha));
  const auto margin = formatted(margin_, Kind::kNumber);
  tables.push_back({fmt::format("Equivalence within {} ({}; two one-sided tests{}, {} intervals)", margin, what,
                                rows_.size() > 1 ? ", uncorrected" : "", level),
                    {{"comparison", Kind::kText},
                     {"difference"},
                     {"lower limit"},
                     {"upper limit"},
                     {"p-value", Kind::kP},
                     {"verdict", Kind::kText}},
                    std::move(rows_)});
  const auto n = equivalent_ + others_;
  const auto which = n == 1             ? std::string{"The difference was "} + (equivalent_ == 1 ? "" : "not ")
                     : others_ == 0     ? fmt::format("All {} differences were ", n)
                     : equivalent_ == 0 ? fmt::format("None of the {} differences was ", n)
                                        : fmt::format("{} of {} differences were ", equivalent_, n);
  finding.sentence += fmt::format(" {}shown to be smaller than {} ({}).", which, margin, what);
  add_method(finding, {fmt::format("two one-sided tests of equivalence within {}", margin)});
}

}  // namespace kith
