#pragma once

#include <cstddef>
#include <optional>

#include "kith/bec/atlas.hpp"
#include "kith/explain/json.hpp"

namespace kith {

/// What the document about a domain contains besides the overview.
struct InspectionContent {
  bool demos = false;              ///< Every demonstration.
  std::optional<std::size_t> mdp;  ///< Demonstrations of this MDP only.
};

/// The document kith.inspect/1: everything about the domain, and its demonstrations if asked for.
[[nodiscard]] Json inspection_json(const Atlas& atlas, const InspectionContent& content);

/// The same document for a domain that cannot be taught, without what concerns teaching.
[[nodiscard]] Json inspection_json(const Domain& domain);

}  // namespace kith
