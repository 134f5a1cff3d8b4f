#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <vector>

#include "kith/core/diagnostic.hpp"
#include "kith/core/integer_vector.hpp"
#include "kith/domains/domain.hpp"
#include "kith/geometry/half_space.hpp"
#include "kith/mdp/planner.hpp"

namespace kith {

using Json = nlohmann::ordered_json;

/// {"schema": "kith.error/1", "errors": [{id, message, file, line, column, hint}]}; what is unknown of the place is
/// null.
[[nodiscard]] Json error_document(const std::vector<Diagnostic>& diagnostics);
/// One of its entries.
[[nodiscard]] Json to_json(const Diagnostic& diagnostic);

[[nodiscard]] Json to_json(const IntegerVector& v);
[[nodiscard]] Json to_json(const Direction& v);
/// Feature counts of a domain: integers, or real numbers where they are expectations.
[[nodiscard]] Json counts_to_json(const Domain& domain, const IntegerVector& counts);
/// {"actions": [name]}, and of a path that never ends "repeats_from", the first action of the cycle.
[[nodiscard]] Json actions_json(const Domain& domain, const Trajectory& path);
/// Normals, shape [n, d]: entries beyond the domain's features are left out.
[[nodiscard]] Json to_json(std::span<const HalfSpace> half_spaces, std::size_t dimension);
/// {"robot": CELL, "items": [{"name", "cell", "carried"}], "stations": [CELL, ...], "mdp": m, "start": n}; a CELL is
/// [column, row] from the top left, from 1. Without a map {"state": n, "name", "mdp": m, "start": n}.
[[nodiscard]] Json start_to_json(const Domain& domain, StartId id);

}  // namespace kith
