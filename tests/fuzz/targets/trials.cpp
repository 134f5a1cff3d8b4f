// Response logs with one row per trial. People are told apart by their names, and their counts are what they should be.

#include <set>

#include "../fuzzing.hpp"
#include "kith/fit/import_logs.hpp"

using namespace kith;

const fuzzing::Form fuzzing::kForm{.words = "trials"};

fuzzing::Outcome fuzzing::run(std::string_view text) {
  const fuzzing::MemoryFile file{text};
  return fuzzing::reads(text, file.path().string(), [&] {
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
}
