#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "condition.hpp"
#include "kith/domains/family_map.hpp"

namespace kith::detail {

struct Feature {
  std::string name;
  Condition when;
  std::string exclusive;             // empty: fires whatever the others do
  std::optional<std::size_t> times;  // the raster whose value it counts, at the cell where the robot then is
  TomlPlace place;                   // of the name
};

// What the robot can do, and what transitions count for.
struct Dynamics {
  double discount = 1.0;
  std::size_t max_steps = 1000;
  std::vector<Action> actions;  // canonical order
  std::vector<Atom> atoms;
  std::vector<Feature> features;
  bool features_are_known = true;  // false: the list is broken, so other names may be right
  std::vector<Condition> forbidden;

  [[nodiscard]] std::vector<std::string> feature_names() const;
};

// Reads [mdp], [[feature]] and [[rule]].
[[nodiscard]] Dynamics read_dynamics(TomlReader& file, const FamilyMap& family_map);

// The largest discount below 1. With it expected counts, up to 1 / (1 - discount) times the largest feature, stay
// within the 2^53 units in which they are kept (expectation_scale()), and choices that differ by a thousandth of a
// feature are told apart.
inline constexpr double kLargestDiscount = 0.999999;

// `discount` of [mdp]: 1 unless the file says otherwise.
[[nodiscard]] double read_discount(TomlReader& mdp);

// Complains about a feature whose name is empty or has blanks around it: sentences are made of names.
void check_feature_name(const TomlReader& feature);

// Feature vectors by atom mask: each distinct mask is evaluated once.
class FeatureTable {
 public:
  explicit FeatureTable(const Dynamics& dynamics);

  struct Row {
    bool forbidden = false;
    std::vector<double> features;  // shape [num_features]
  };

  // The number of the row for `mask`, and for a cell with these counts.
  [[nodiscard]] std::uint32_t row_of(AtomMask mask, std::uint32_t counts);
  // The number of these values of rasters, one for each feature that counts one, in order. Without any it is 0.
  [[nodiscard]] std::uint32_t counts_of(const std::vector<std::uint16_t>& values);
  [[nodiscard]] const Row& row(std::uint32_t index) const { return rows_[index]; }
  [[nodiscard]] std::size_t size() const { return rows_.size(); }

 private:
  [[nodiscard]] Row evaluate(AtomMask mask, const std::vector<std::uint16_t>& values) const;

  const Dynamics& dynamics_;
  std::vector<std::unordered_map<AtomMask, std::uint32_t>> numbers_;  // per number of counts
  std::map<std::vector<std::uint16_t>, std::uint32_t> counts_numbers_;
  std::vector<std::vector<std::uint16_t>> counts_;
  std::vector<Row> rows_;
};

}  // namespace kith::detail
