#include "kith/teaching/imitation_table.hpp"

#include <algorithm>

#include "kith/bec/transfer.hpp"

namespace kith {

ImitationTable::ImitationTable(const Atlas& atlas, const Exam& exam) : atlas_{&atlas} {
  constexpr std::size_t kOfEach = 30;
  for (const auto difficulty : {ExamDifficulty::kLow, ExamDifficulty::kMedium, ExamDifficulty::kHigh}) {
    const auto all = exam.starts(difficulty);
    const auto n = std::min(kOfEach, all.size());
    for (std::size_t i = 0; i < n; ++i) starts_.push_back(all[i * all.size() / n]);
  }
}

std::span<const ImitationTable::Copy> ImitationTable::of(StartIndex demonstration) {
  const auto [place, is_new] = rows_.try_emplace(demonstration.value());
  auto& row = place->second;
  if (!is_new) return row;
  for (const auto test : starts_) {
    auto& copy = row.emplace_back();
    copy.distance = static_cast<double>(atlas_->domain().dissimilarity(atlas_->id(demonstration), atlas_->id(test)));
    auto copied = transferred(*atlas_, demonstration, test);
    if (copied && copied->rest) copied->counts += atlas_->feature_counts(*copied->rest);
    // Whoever cannot copy goes the own way: here the robot's.
    copy.grade = copied ? grade_answer(*atlas_, test, copied->counts) : Grade{1.0, 0.0};
  }
  return row;
}

}  // namespace kith
