#include "session_tables.hpp"

#include <algorithm>
#include <sstream>

#include "kith/files/atomic_file.hpp"
#include "kith/files/column_names.hpp"
#include "kith/files/published_run.hpp"
#include "kith/files/sha256.hpp"

namespace kith::detail {
namespace {

namespace fs = std::filesystem;

constexpr const char* kAboutFile = "study.json";
constexpr const char* kSumsFile = "SHA256SUMS";

[[noreturn]] void refuse_changed(const fs::path& file) {
  refuse_run(ErrorKind::kMismatch, "E0607", file, "the file is not the one that was exported: its hash differs",
             "export the session again, or analyse an edited copy with 'kith analyze FILE --model ...'");
}

// Hashes by file, each checked.
std::map<std::string, std::string> checked_sums(const fs::path& folder) {
  std::map<std::string, std::string> sums;
  std::istringstream lines{read_file(folder / kSumsFile)};
  for (std::string hash, name; lines >> hash >> name;) {
    const auto file = folder / name;
    std::error_code failure;
    if (fs::path{name}.has_parent_path() || !fs::is_regular_file(file, failure)) {
      refuse_run(ErrorKind::kInvalidInput, "E0604", file, "the table is missing", "export the session again");
    }
    if (sha256(read_file(file)) != hash) refuse_changed(file);
    sums[name] = hash;
  }
  return sums;
}

class Reader {
 public:
  Reader(fs::path folder, const std::map<std::string, std::string>& sums) : folder_{std::move(folder)}, sums_{sums} {}

  [[nodiscard]] std::string text(const std::string& name) const {
    if (sums_.find(name) == sums_.end()) {
      refuse_run(ErrorKind::kInvalidInput, "E0604", folder_ / name, "the table is missing", "export the session again");
    }
    return read_file(folder_ / name);
  }
  [[nodiscard]] Dataset table(const std::string& name) const {
    return Dataset::parse(text(name), (folder_ / name).string());
  }

 private:
  fs::path folder_;
  const std::map<std::string, std::string>& sums_;
};

std::vector<std::string> texts_of(const Json& about, const char* key) {
  const auto found = about.find(key);
  return found == about.end() ? std::vector<std::string>{} : found->get<std::vector<std::string>>();
}

// Where a value stands in a list; at its end if it is not in it.
std::size_t rank_in(const std::vector<std::string>& list, const std::string& value) {
  return static_cast<std::size_t>(std::find(list.begin(), list.end(), value) - list.begin());
}

std::vector<LiveGroup> groups_of(const Dataset& sessions, const Json& about) {
  const auto text = [&](const char* column, std::size_t i) { return sessions.cells(column)[i].value_or(""); };
  const auto started = sessions.numbers(columns::kStartedMs), replicate = sessions.numbers(columns::kReplicate),
             people = sessions.numbers(columns::kPeople), completed = sessions.numbers(columns::kCompleted),
             periods = sessions.numbers(columns::kPeriods), knowledge = sessions.numbers(columns::kKnowledge);

  std::vector<LiveGroup> groups;
  for (std::size_t i = 0; i < sessions.num_rows(); ++i) {
    if (!started[i]) continue;
    groups.push_back({.session = text(columns::kSession, i),
                      .strategy = text(columns::kStrategy, i),
                      .composition = text(columns::kComposition, i),
                      .replicate = static_cast<std::size_t>(replicate[i].value_or(0.0)),
                      .people = static_cast<std::size_t>(people[i].value_or(0.0)),
                      .completed = completed[i].value_or(0.0) != 0.0,
                      .periods = static_cast<std::size_t>(periods[i].value_or(0.0)),
                      .knowledge = knowledge[i],
                      .ended = text(columns::kEnded, i)});
  }

  const auto strategies = texts_of(about, "strategies"), compositions = texts_of(about, "compositions");
  const auto key = [&](const LiveGroup& group) {
    return std::tuple{rank_in(strategies, group.strategy), group.strategy, rank_in(compositions, group.composition),
                      group.composition, group.replicate};
  };
  std::stable_sort(groups.begin(), groups.end(),
                   [&](const LiveGroup& a, const LiveGroup& b) { return key(a) < key(b); });
  return groups;
}

}  // namespace

std::optional<std::size_t> SessionTables::group_of(const std::string& session) const {
  for (std::size_t i = 0; i < groups.size(); ++i) {
    if (groups[i].session == session) return i;
  }
  return std::nullopt;
}

bool is_session_export(const fs::path& folder) {
  std::error_code failure;
  return fs::is_regular_file(folder / kAboutFile, failure) && fs::is_regular_file(folder / kSumsFile, failure) &&
         !fs::exists(folder / "manifest.json", failure);
}

SessionTables read_session_tables(const fs::path& folder) {
  const auto sums = checked_sums(folder);
  const Reader reader{folder, sums};
  auto about = Json::parse(reader.text(kAboutFile), nullptr, false);
  if (about.is_discarded() || about.value("schema", "") != "kith.session-tables/1") {
    refuse_run(ErrorKind::kMismatch, "E0605", folder / kAboutFile, "the export was written by another version of kith",
               "export the session again with this version");
  }
  auto sessions = reader.table("sessions.csv");
  auto groups = groups_of(sessions, about);
  const auto num_waiting = sessions.num_rows() - groups.size();
  return {.folder = folder,
          .about = std::move(about),
          .hashes = sums,
          .groups = std::move(groups),
          .num_waiting = num_waiting,
          .sessions = std::move(sessions),
          .participants = reader.table("participants.csv"),
          .periods = reader.table("periods.csv"),
          .tests = reader.table("tests.csv"),
          .beliefs = reader.table("beliefs.csv")};
}

}  // namespace kith::detail
