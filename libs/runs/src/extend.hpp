#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kith/runs/journal.hpp"
#include "kith/study/study.hpp"

// A study that goes on with more teams, and what tells studies apart.
namespace kith {

// Whether `now` is `earlier` with more replicates and nothing else: its teams are among those of `now`.
[[nodiscard]] bool extends(const RunInputs& earlier, const RunInputs& now);

// "teacher.particles 500 -> 400": the keys in which two frozen studies differ, and which other inputs do.
[[nodiscard]] std::vector<std::string> differences(const RunInputs& earlier, const RunInputs& now);

// Makes the journal of an extended study of the one at `path`, whose teams it takes over under their new numbers. The
// old one stays until the new one is complete; whatever ends this, one of the two is there.
// @param study  the extended one.
// @pre extends(earlier.inputs, identity.inputs), and both are of the same program and the whole study.
void extend_journal(const std::filesystem::path& path, const JournalIdentity& earlier, const JournalIdentity& identity,
                    const Study& study);

// Where extend_journal() makes the new journal.
[[nodiscard]] std::filesystem::path extended_file(const std::filesystem::path& path);

}  // namespace kith
