#pragma once

#include "console.hpp"
#include "transcript.hpp"

namespace kith::cli {

/// Prints the document kith.teach/1: all that the text of the transcript says.
void print_transcript(const Atlas& atlas, const Transcript& transcript, Console& console);

}  // namespace kith::cli
