#include <algorithm>
#include <stdexcept>

#include "expectations.hpp"

namespace kith {
namespace {

class TabulatedExpectations : public Expectations {
 public:
  TabulatedExpectations(const Atlas& atlas, std::size_t max_row_bytes)
      : atlas_{&atlas}, tables_{&atlas.tables()}, rows_by_cell_(atlas.tables().cells().size()) {
    max_cells_with_rows_ = std::max<std::size_t>(max_row_bytes / std::max<std::size_t>(bytes_of_rows(), 1), 1);
  }

  PolicyCellIndex locate(const Direction& weights) override {
    return tables_->cells().locate(Eigen::Vector3d{weights});
  }
  std::optional<IntegerVector> answer(StartIndex start, PolicyCellIndex cell) override {
    return tables_->answer(start, cell);
  }
  [[nodiscard]] const Direction& weights(PolicyCellIndex /*cell*/) const override {
    throw std::invalid_argument{"Behaviours::weights: a policy cell of an atlas with tables is of many weights"};
  }
  Behaviours::Conveyed conveyed_by_class(const KnowledgeComponent& component,
                                         std::span<const PolicyCellIndex> cells) override;
  ConstraintSet conveyed(StartIndex start, std::span<const PolicyCellIndex> cells) override {
    return tables_->conveyed(atlas_->start_class(start), cells);
  }
  [[nodiscard]] std::size_t memory() const noexcept override { return cells_with_rows_.size() * bytes_of_rows(); }

 private:
  // Of one cell.
  [[nodiscard]] std::size_t bytes_of_rows() const noexcept {
    return atlas_->num_start_classes() * atlas_->words_per_set() * sizeof(std::uint64_t);
  }
  const std::vector<std::uint64_t>& rows_of(PolicyCellIndex cell);

  const Atlas* atlas_;
  const BehaviourTables* tables_;
  std::vector<std::vector<std::uint64_t>> rows_by_cell_;  // empty where not asked for yet, or forgotten
  std::vector<PolicyCellIndex> cells_with_rows_;          // a ring of max_cells_with_rows_
  std::size_t max_cells_with_rows_ = 1;
  std::size_t oldest_rows_ = 0;
  std::vector<std::uint64_t> rows_;  // the union of those asked for
};

// Makes room for the rows of a cell; those kept for longest give way.
const std::vector<std::uint64_t>& TabulatedExpectations::rows_of(PolicyCellIndex cell) {
  auto& rows = rows_by_cell_[cell.value()];
  if (!rows.empty()) return rows;
  if (cells_with_rows_.size() < max_cells_with_rows_) {
    cells_with_rows_.push_back(cell);
  } else {
    std::vector<std::uint64_t>{}.swap(rows_by_cell_[cells_with_rows_[oldest_rows_].value()]);
    cells_with_rows_[oldest_rows_] = cell;
    oldest_rows_ = (oldest_rows_ + 1) % max_cells_with_rows_;
  }
  return rows = tables_->conveyed_by_class({&cell, 1});
}

// Each cell's rows are computed once; several are their union.
Behaviours::Conveyed TabulatedExpectations::conveyed_by_class(const KnowledgeComponent& /*component*/,
                                                              std::span<const PolicyCellIndex> cells) {
  rows_.assign(atlas_->num_start_classes() * atlas_->words_per_set(), 0);
  for (const auto cell : cells) {
    const auto& rows = rows_of(cell);
    const std::uint64_t* const from = rows.data();  // unchecked, for speed
    std::uint64_t* const to = rows_.data();
    for (std::size_t i = 0; i < rows.size(); ++i) to[i] |= from[i];
  }
  return {atlas_->words_per_set(), rows_, {}};
}

}  // namespace

std::unique_ptr<Expectations> expect_by_tables(const Atlas& atlas, std::size_t max_row_bytes) {
  return std::make_unique<TabulatedExpectations>(atlas, max_row_bytes);
}

}  // namespace kith
