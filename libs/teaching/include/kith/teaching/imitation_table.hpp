#pragma once

#include <cstddef>
#include <span>
#include <unordered_map>
#include <vector>

#include "kith/bec/atlas.hpp"
#include "kith/bec/grade_table.hpp"
#include "kith/teaching/exam.hpp"

namespace kith {

/// What it comes to when somebody answers by pressing the keys of a demonstration again (transferred()), on some 90
/// starts of the exam, 30 of each difficulty. From where the keys lead the robot's own way is taken. A cache in front
/// of a pure function. The atlas must outlive it.
class ImitationTable {
 public:
  ImitationTable(const Atlas& atlas, const Exam& exam);

  struct Copy {
    double distance = 0.0;  ///< Of the demonstration's start from the test's, Domain::dissimilarity().
    Grade grade;            ///< Of what is copied.
  };
  /// One per start; valid until the next call.
  [[nodiscard]] std::span<const Copy> of(StartIndex demonstration);
  [[nodiscard]] std::size_t num_starts() const noexcept { return starts_.size(); }
  /// About how much is remembered, in bytes.
  [[nodiscard]] std::size_t memory() const noexcept { return rows_.size() * starts_.size() * sizeof(Copy); }

 private:
  const Atlas* atlas_;
  std::vector<StartIndex> starts_;
  std::unordered_map<std::size_t, std::vector<Copy>> rows_;
};

}  // namespace kith
