#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "kith/domains/domain.hpp"
#include "kith/study/group_options.hpp"

namespace kith {

/// Fills in the standard texts where a study gives none. The story ends with explained_to_people(), unless people read
/// another language.
void fill_in_texts(GroupOptions& group, const Domain& domain);

/// "Learner A" for the first member, "Learner AA" behind "Learner Z".
[[nodiscard]] std::string member_label(std::size_t member);

/// Paragraphs of a text: separated by empty lines, line breaks within them become blanks.
[[nodiscard]] std::vector<std::string> paragraphs_of(std::string_view text);

/// With a capital letter in front and a full stop at the end.
[[nodiscard]] std::string sentence(std::string text);

}  // namespace kith
