#pragma once

#include <iosfwd>
#include <optional>
#include <vector>

#include "kith/bec/atlas.hpp"
#include "kith/explain/curriculum.hpp"

namespace kith {

/// As failures show it.
void PrintTo(const IntegerVector& v, std::ostream* out);

}  // namespace kith

namespace kith::laws {

/// Per feature the one of another domain that it counts; none: it never occurs.
using Counted = std::vector<std::optional<std::size_t>>;

/// v with the features of another domain: entry k is the entry counted[k] of v, or 0.
[[nodiscard]] IntegerVector carried_over(const IntegerVector& v, const Counted& counted);
/// The normals, sorted.
[[nodiscard]] std::vector<IntegerVector> carried_over(const std::vector<HalfSpace>& all, const Counted& counted);

struct ComponentFacts {
  std::vector<std::size_t> features;
  std::vector<IntegerVector> constraints;
  std::size_t num_worlds = 0;
  friend auto operator<=>(const ComponentFacts&, const ComponentFacts&) = default;
  /// As failures show it.
  friend void PrintTo(const ComponentFacts& facts, std::ostream* out);
};

/// A constraint, and how many demonstrations teach or test it and nothing else.
struct IsolationFacts {
  IntegerVector constraint;
  std::size_t teaching = 0, testing = 0;
  friend auto operator<=>(const IsolationFacts&, const IsolationFacts&) = default;
  friend void PrintTo(const IsolationFacts& facts, std::ostream* out);
};

/// What is known of a robot before anybody is taught, whatever its states are called, in the features of another
/// domain.
struct Facts {
  std::size_t num_worlds = 0;
  std::vector<IntegerVector> counts;       ///< Of the robot's path from every start; sorted.
  std::vector<IntegerVector> region;       ///< The normals of its facets; sorted.
  std::vector<ComponentFacts> components;  ///< Sorted.
  std::vector<std::size_t> mask_counters;  ///< Per feature.
};
[[nodiscard]] Facts facts_of(const Atlas& atlas, const Counted& counted);
/// What `find` lists; sorted.
[[nodiscard]] std::vector<IsolationFacts> isolations_of(const Atlas& atlas, const Counted& counted);

/// Those of the domain itself.
[[nodiscard]] Counted identity(const Domain& domain);

/// Equal features of the same sort that order decides between: then so may do what is taught.
[[nodiscard]] bool has_equal_counters(const Atlas& atlas);

/// The features that are weighed in the components that a curriculum teaches and in those that it skips; sorted.
struct TaughtFacts {
  std::vector<std::vector<std::size_t>> taught, skipped;
  [[nodiscard]] std::vector<std::vector<std::size_t>> all() const;  ///< Sorted.
  friend bool operator==(const TaughtFacts&, const TaughtFacts&) = default;
  friend void PrintTo(const TaughtFacts& facts, std::ostream* out);
};
[[nodiscard]] TaughtFacts taught_facts(const Atlas& atlas, const Curriculum& curriculum, const Counted& counted);

}  // namespace kith::laws
