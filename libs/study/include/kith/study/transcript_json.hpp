#pragma once

#include "kith/explain/json.hpp"
#include "kith/study/transcript.hpp"

namespace kith {

/// The document kith.teach/1: all that the text of the transcript says.
[[nodiscard]] Json transcript_json(const Atlas& atlas, const Transcript& transcript);

}  // namespace kith
