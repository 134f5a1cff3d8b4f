#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kith/domains/domain.hpp"

namespace kith {

/// The domain file with another map and with nothing optional: a family of one MDP. Comments, features, rules, reward
/// and words stay as they are.
/// @param text  a sound domain file.
/// @param id    the new domain's.
/// @param rows  top row first, in symbols of the file's legend.
/// @return nothing if the new file is not sound: the map has no start or two, say, or is written in a way that is
/// not understood here.
[[nodiscard]] std::optional<std::string> with_one_map(std::string_view text, const std::string& id,
                                                      const std::vector<std::string>& rows);

/// The domain file with weights that were inferred, in place of its [reward] and [inferred]; the rest stays as it is.
/// The text need not be a sound domain file, but must be TOML.
/// @param weights   shape [d], by feature name in the order of `features`.
/// @param inferred  its not_explained ascending; its left_out does not matter.
/// @param left_out  starts that the weights do not explain, ascending.
[[nodiscard]] std::string with_inferred_weights(std::string_view text, const std::vector<std::string>& features,
                                                const std::vector<double>& weights, const InferredWeights& inferred,
                                                const std::vector<StartId>& left_out);

}  // namespace kith
