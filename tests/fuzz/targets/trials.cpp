// Response logs with one row per trial. People are told apart by their names, and their counts are what they should be.

#include <set>

#include "../fuzzing.hpp"
#include "kith/fit/import_trials.hpp"

using namespace kith;

std::string fuzzing::mutated(std::string_view input, Dice& dice) {
  static const Vocabulary kVocabulary{"trials"};
  return mutate_text(input, kVocabulary, dice);
}

std::string fuzzing::crossed(std::string_view input, std::string_view other, Dice& dice) {
  return cross_text(input, other, dice);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text{reinterpret_cast<const char*>(data), size};
  const fuzzing::MemoryFile file{text};
  const auto outcome = fuzzing::reads(text, file.path().string(), [&] {
    const auto logs = import_trials(file.path());
    fuzzing::require(!has_errors(logs.notes), "what was read has no errors");
    fuzzing::require_good(logs.notes, text, file.path().string());
    std::set<std::string> names;
    for (const auto& person : logs.people) {
      fuzzing::require(names.insert(person.id).second, "nobody has another's name", person.id);
      fuzzing::require(person.model < logs.models.size(), "everybody has a model");
      fuzzing::require(person.correct <= person.answered && person.answered == person.periods.size(),
                       "a period per answer, and not more of them right than there are", person.id);
      for (const auto& period : person.periods) fuzzing::require(period.component >= 1, "components count from 1");
    }
  });
  fuzzing::note(text, outcome);
  return 0;
}
