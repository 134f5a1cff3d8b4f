#pragma once

#include <cstdint>
#include <string>

#include "kith/explain/curriculum.hpp"
#include "kith/explain/json.hpp"

namespace kith {

/// The document kith.curriculum/1, which the lesson page shows (docs/json.md).
/// @param seed     that the curriculum was made with. @param program  that made it, such as "kith 0.1.0".
[[nodiscard]] Json curriculum_json(const Atlas& atlas, const Curriculum& curriculum, std::uint64_t seed,
                                   const std::string& program);

/// What is new and what is not, for people who know the robot as it was.
[[nodiscard]] Json update_json(const UpdateInWords& update);

/// The same, smaller: where every outcome is certain, paths have the names of their "actions" in place of their frames,
/// which a page works out from the tables of moves.
[[nodiscard]] Json for_page(Json curriculum);

}  // namespace kith
