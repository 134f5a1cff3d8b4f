#include "extend.hpp"

#include <algorithm>
#include <map>
#include <system_error>

#include "kith/core/error.hpp"
#include "kith/runs/team_codec.hpp"

namespace kith {
namespace {

namespace fs = std::filesystem;

constexpr const char* kReplicates = "replicates";

// The values of a frozen study by dotted key. Its text has one key on a line.
std::map<std::string, std::string> values_of(const std::string& study) {
  std::map<std::string, std::string> values;
  std::string section;
  std::size_t number = 0;  // of a table in a list
  for (std::size_t begin = 0; begin < study.size();) {
    const auto end = std::min(study.find('\n', begin), study.size());
    const auto line = study.substr(begin, end - begin);
    begin = end + 1;
    const auto equals = line.find(" = ");
    if (line.starts_with("[[")) {
      section = line.substr(2, line.find(']') - 2) + "[" + std::to_string(++number) + "].";
    } else if (line.starts_with("[")) {
      section = line.substr(1, line.find(']') - 1) + ".";
    } else if (equals != std::string::npos) {
      values[section + line.substr(0, equals)] = line.substr(equals + 3);
    }
  }
  return values;
}

std::size_t replicates_of(const std::map<std::string, std::string>& values) {
  const auto found = values.find(kReplicates);
  constexpr std::size_t kMostDigits = 9;
  if (found == values.end() || found->second.empty() || found->second.size() > kMostDigits) return 0;
  const bool is_number = found->second.find_first_not_of("0123456789") == std::string::npos;
  return is_number ? std::stoul(found->second) : 0;
}

// The text without the line that says how many there are.
std::string without_replicates(std::string study) {
  const auto begin = study.find(std::string{"\n"} + kReplicates + " = ");
  if (begin != std::string::npos) study.erase(begin, study.find('\n', begin + 1) - begin);
  return study;
}

}  // namespace

bool extends(const RunInputs& earlier, const RunInputs& now) {
  if (earlier.domain != now.domain || earlier.files != now.files) return false;
  const auto before = replicates_of(values_of(earlier.study));
  if (before == 0 || before >= replicates_of(values_of(now.study))) return false;
  return without_replicates(earlier.study) == without_replicates(now.study);
}

std::vector<std::string> differences(const RunInputs& earlier, const RunInputs& now) {
  std::vector<std::string> all;
  const auto before = values_of(earlier.study);
  const auto after = values_of(now.study);
  for (const auto& [key, value] : before) {
    const auto found = after.find(key);
    if (found == after.end()) all.push_back(key + " " + value + " -> none");
    if (found != after.end() && found->second != value) all.push_back(key + " " + value + " -> " + found->second);
  }
  for (const auto& [key, value] : after) {
    if (!before.contains(key)) all.push_back(key + " none -> " + value);
  }
  if (earlier.domain != now.domain) all.emplace_back("the domain file");
  if (earlier.files != now.files) all.emplace_back("files of the domain");
  return all;
}

fs::path extended_file(const fs::path& path) { return fs::path{path}.replace_filename("study.extended.sqlite"); }

void extend_journal(const fs::path& path, const JournalIdentity& earlier, const JournalIdentity& identity,
                    const Study& study) {
  const auto before = replicates_of(values_of(earlier.inputs.study));
  const auto file = extended_file(path);
  {
    auto old = Journal::open(path, earlier);
    if (!old) {
      throw Error{ErrorKind::kIo, path.string() + " is damaged, and no record of this study can be read from it",
                  Advice{"restore the file from a copy", Remedy::kStartOver}};
    }
    for (const auto& part : rank_journals(path.parent_path())) {
      if (Journal::identify(part) != earlier) continue;
      if (const auto opened = Journal::open(part, earlier)) old->absorb(*opened);
    }
    auto extended = Journal::create(file, identity);
    constexpr std::size_t kBatch = 500;
    std::vector<JournalEntry> batch;
    std::size_t number = 0;  // of the team in the earlier study, which has the same order
    for (const auto& address : team_addresses(study)) {
      if (address.replicate > before) continue;
      ++number;
      const auto bytes = old->done()[number - 1] ? old->find(number) : std::nullopt;
      if (!bytes) continue;
      auto there = address;
      there.team = number;
      auto record = decode_team(there, *bytes, old->key());
      if (!record) continue;
      record->address = address;
      batch.push_back({address.team, encode_team(*record, extended.key())});
      if (batch.size() < kBatch) continue;
      extended.write(batch);
      batch.clear();
    }
    extended.write(batch);
    extended.close();
    old->close();
  }
  for (const auto* suffix : {"-wal", "-shm"}) {
    std::error_code ignored;
    for (const auto& one : {file, path}) fs::remove(fs::path{one}.concat(suffix), ignored);
  }
  std::error_code failure;
  fs::rename(file, path, failure);
  if (failure) throw Error{ErrorKind::kIo, "cannot replace " + path.string() + ": " + failure.message()};
}

}  // namespace kith
