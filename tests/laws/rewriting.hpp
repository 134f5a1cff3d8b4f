#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kith/core/stream.hpp"
#include "kith/domains/domain_file.hpp"
#include "kith/files/value.hpp"

namespace kith::laws {

/// A domain as text that can be rewritten.
struct DomainText {
  std::string name;
  TomlTable root;
  std::vector<DomainFile> files{};

  [[nodiscard]] std::string toml() const;
  [[nodiscard]] DomainReading read() const { return parse_domain(toml(), name + ".toml", {}, {.known = files}); }
};

/// @throws std::logic_error if the text is no TOML.
[[nodiscard]] DomainText domain_text(const std::string& name, std::string_view text,
                                     std::vector<DomainFile> files = {});
/// The domains that come with kith and those of domains/ and domains/gallery that do not.
[[nodiscard]] std::vector<DomainText> known_domains();

/// The same robot, said in another way.
struct Rewriting {
  std::string how;
  DomainText text;
  /// Per feature of the new text the one of the old text that it counts; none: it never occurs.
  std::vector<std::optional<std::size_t>> counts{};
  bool same_states = true;    ///< Worlds and states have the same numbers.
  bool same_vectors = true;   ///< Feature vectors and the direction of the weights are the same, entry by entry.
  bool same_features = true;  ///< As many features, in whatever order.
};

// Each gives nothing where the domain cannot be said in that way.

[[nodiscard]] std::optional<Rewriting> with_features_permuted(const DomainText& domain, RandomStream random);
/// @param factor  of all weights; their decimals stay exact.
[[nodiscard]] std::optional<Rewriting> with_weights_scaled(const DomainText& domain, double factor);
[[nodiscard]] std::optional<Rewriting> mirrored(const DomainText& domain);
[[nodiscard]] std::optional<Rewriting> transposed(const DomainText& domain);
/// Features, terrain, stations, items and goals have other names, whose alphabetical order is another one.
[[nodiscard]] std::optional<Rewriting> renamed(const DomainText& domain);
[[nodiscard]] std::optional<Rewriting> with_a_feature_that_never_occurs(const DomainText& domain, RandomStream random);
/// A feature stands there twice, each time with half of its weight.
[[nodiscard]] std::optional<Rewriting> with_a_copy_of_a_feature(const DomainText& domain, RandomStream random);
/// An explicit model whose first MDP is there twice.
[[nodiscard]] std::optional<Rewriting> with_a_world_twice(const DomainText& domain);

[[nodiscard]] DomainText with_discount(const DomainText& domain, double discount);

}  // namespace kith::laws
