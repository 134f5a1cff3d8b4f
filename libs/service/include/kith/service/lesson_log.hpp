#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "kith/explain/json.hpp"
#include "kith/store/session_study.hpp"

namespace kith {

/// The document of a lesson file, schema kith.lesson/1: {kith, title, digest, inputs, setup}. The setup is that of a
/// room for one person: the first strategy of the study that can teach one person, and the first composition's first
/// type of learner.
/// @param program  name and version of what makes the file.
/// @throws kith::Error (kInfeasible) if people wait for a group in the study.
[[nodiscard]] Json lesson_document(const SessionStudy& session, const std::string& program);

/// What was added to a session.
struct ImportedLog {
  std::string room;        ///< Its id.
  std::size_t events = 0;  ///< That the session did not have yet.
};

/// Adds the log of a lesson file (schema kith.lesson-log/1) to the folder of a session as one more room; makes the
/// folder if there is none. Of a log that goes on from one that is there, what is new is added. The log is replayed
/// first: every lesson must show and ask what this kith would, and the seal fit the events, so that a log that was
/// edited is noticed.
/// @param name  of the log, for messages.
/// @throws kith::Error kInvalidInput E1621 (no such log, or it was cut off), kMismatch E1622 (it was changed, or is of
/// another version), kUsage E1623 (the folder has a log of this person that went another way); as EventFile::open().
[[nodiscard]] ImportedLog import_lesson_log(const std::filesystem::path& folder, std::string_view text,
                                            const std::string& name, const std::string& program, std::int64_t now_us);

}  // namespace kith
