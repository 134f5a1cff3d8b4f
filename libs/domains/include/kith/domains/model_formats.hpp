#pragma once

#include <string>
#include <vector>

#include "kith/domains/model_text.hpp"
#include "kith/domains/raw_model.hpp"

// The tables of docs/explicit-models.md: what is wrong is reported, the rest added to the model.
namespace kith::detail {

// A model larger than that is not read.
inline constexpr std::size_t kMaxModelBytes = std::size_t{64} << 20;  // of one file
inline constexpr std::size_t kMaxTransitions = 8'000'000;             // of all MDPs
inline constexpr std::size_t kMaxModelStates = 2'000'000;             // of all MDPs
inline constexpr std::size_t kMaxModelMdps = 65'536;
inline constexpr std::size_t kMaxModelActions = 1'000;
inline constexpr std::size_t kMaxVariables = 64;

// kith's own tables. `features` are columns of the transitions.
void read_csv_model(const ModelText& states, const ModelText& transitions, const std::vector<std::string>& features,
                    RawModel& model, ModelReport& report);

// Whether one more transition may come; reports once if not.
[[nodiscard]] bool has_room(const RawModel& model, const ModelPlace& place, ModelReport& report);
// The action's number; nothing after reporting that it is none of those declared, or one too many.
[[nodiscard]] std::optional<std::uint32_t> action_number(RawModel& model, const std::string& name,
                                                         const ModelPlace& place, ModelReport& report);
// "did you mean 'X'?" for the nearest of the known names, or a list of them if they are few.
[[nodiscard]] std::string name_hint(const std::string& name, const std::vector<std::string>& known);
// Reports a feature or reward that is not finite, or 2^31 or more in size.
[[nodiscard]] bool check_finite(double number, const std::string& what, const ModelPlace& place, ModelReport& report);

}  // namespace kith::detail
