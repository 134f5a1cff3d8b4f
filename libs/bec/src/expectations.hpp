#pragma once

#include <memory>
#include <optional>
#include <span>

#include "kith/bec/behaviours.hpp"

namespace kith {

// Of a word of a row of Behaviours::Conveyed.
inline constexpr std::size_t kBits = 64;
// What a hash table keeps beside each entry: a node of about two pointers and a bucket.
inline constexpr std::size_t kBytesOfNode = 3 * sizeof(void*);

// What people expect: see Behaviours, which asks this. One way of finding out is chosen when Behaviours is made.
class Expectations {
 public:
  Expectations() = default;
  Expectations(const Expectations&) = delete;
  Expectations& operator=(const Expectations&) = delete;
  virtual ~Expectations() = default;

  virtual PolicyCellIndex locate(const Direction& weights) = 0;
  virtual std::optional<IntegerVector> answer(StartIndex start, PolicyCellIndex cell) = 0;
  // Throws std::invalid_argument where a cell is not of one person's weights.
  [[nodiscard]] virtual const Direction& weights(PolicyCellIndex cell) const = 0;
  virtual Behaviours::Conveyed conveyed_by_class(const KnowledgeComponent& component,
                                                 std::span<const PolicyCellIndex> cells) = 0;
  virtual ConstraintSet conveyed(StartIndex start, std::span<const PolicyCellIndex> cells) = 0;
  // In bytes, without the constraints.
  [[nodiscard]] virtual std::size_t memory() const noexcept = 0;
};

// Looked up in the tables of the atlas.
[[nodiscard]] std::unique_ptr<Expectations> expect_by_tables(const Atlas& atlas, std::size_t max_row_bytes);

// Planned when weights are met, and remembered. Constraints met on the way are added to `constraints`, which has to
// outlive it.
[[nodiscard]] std::unique_ptr<Expectations> expect_by_plans(const Atlas& atlas, ConstraintTable& constraints,
                                                            std::size_t max_cells, std::size_t max_row_bytes,
                                                            std::shared_ptr<PolicyPartitions> partitions);

}  // namespace kith
