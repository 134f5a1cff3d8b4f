#include "folders.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "kith/files/atomic_file.hpp"
#include "kith/files/published_run.hpp"
#include "kith/files/sha256.hpp"

namespace kith::fuzzing {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// Where an edit is made, and how.
struct Place {
  std::size_t at = 0;  // two bytes
  std::uint64_t how = 0;
};

void replace_line(std::string& text, std::size_t at, std::size_t copies) {
  const auto before = text.rfind('\n', at);
  const auto begin = before == std::string::npos ? 0 : before + 1;
  const auto end = std::min(text.size(), text.find('\n', at)) + 1;
  const auto line = text.substr(begin, end - begin);
  std::string now;
  for (std::size_t i = 0; i < copies; ++i) now += line;
  text.replace(begin, line.size(), now);
}

std::string mutated_file(const std::string& name, const std::string& text, Dice& dice) {
  static const Vocabulary kStudy{"study"};
  static const Vocabulary kTables{"run_table"};
  if (name.ends_with(".toml")) return mutate_text(text, kStudy, dice);
  return name.ends_with(".sqlite") ? mutate_bytes(text, dice) : mutate_text(text, kTables, dice);
}

// Damage such as a disk does.
void damage(std::string& file, unsigned kind, const Place& place) {
  constexpr std::size_t kSector = 512;
  constexpr std::size_t kPage = 4096;
  if (file.empty()) return;
  const auto at = place.at % file.size();
  switch (kind) {
    case 0:
    case 1:
      file[at] = static_cast<char>(file[at] ^ (1 << (place.how % 8)));
      return;
    case 2:
      file[at] = static_cast<char>(place.how % 256);
      return;
    case 3:
      file.resize(at);
      return;
    case 4:
      file.replace(at / kSector * kSector, std::min(kSector, file.size() - at / kSector * kSector), kSector, '\0');
      return;
    case 5: {  // a page in place of another
      const auto pages = file.size() / kPage;
      if (pages < 2) return;
      file.replace(place.how % pages * kPage, kPage, file.substr(place.at % pages * kPage, kPage));
      return;
    }
    default:
      replace_line(file, at, place.how % 3);
  }
}

}  // namespace

FolderContent content_of(const fs::path& folder) {
  FolderContent content;
  for (const auto& entry : fs::recursive_directory_iterator{folder}) {
    if (entry.is_regular_file()) content[entry.path().lexically_relative(folder).string()] = read_file(entry.path());
  }
  return content;
}

void put(const fs::path& folder, const FolderContent& content) {
  const auto before = content_of(folder);
  for (const auto& [name, text] : before) {
    if (content.find(name) == content.end()) fs::remove(folder / name);
  }
  for (const auto& [name, text] : content) {
    const auto found = before.find(name);
    if (found != before.end() && found->second == text) continue;
    fs::create_directories((folder / name).parent_path());
    write_file_atomically(folder / name, text);
  }
}

FolderContent edited(FolderContent content, const FolderContent& foreign, Bytes& bytes) {
  constexpr std::array<const char*, 6> kMore{"study.sqlite-journal", "study.sqlite-wal", "study.sqlite.damaged",
                                             "tables/more.csv",      "inputs/more.toml", "study.rank-1.sqlite"};
  while (!bytes.empty() && !content.empty()) {
    const auto kind = bytes.below(16);
    const auto file = std::next(content.begin(), static_cast<std::ptrdiff_t>(bytes.below(content.size())));
    const auto high = bytes.below(256);
    Place place{.at = high * 256 + bytes.below(256)};
    place.how = bytes.below(256);
    place.how = place.how * 256 + bytes.below(256);
    auto& text = file->second;
    if (kind < 7) {
      damage(text, static_cast<unsigned>(kind), place);
    } else if (kind < 12) {
      Dice dice{place.at * 65'536 + place.how};
      text = mutated_file(file->first, text, dice);
    } else if (kind == 12) {
      content.erase(file);
    } else if (kind == 13) {
      std::swap(text, std::next(content.begin(), static_cast<std::ptrdiff_t>(place.how % content.size()))->second);
    } else if (kind == 14) {
      const auto other = foreign.find(file->first);
      if (other != foreign.end()) text = other->second;
    } else {
      const auto other = std::next(foreign.begin(), static_cast<std::ptrdiff_t>(place.at % foreign.size()));
      content[kMore.at(place.how % kMore.size())] = other->second;
    }
  }
  return content;
}

FolderContent with_matching_manifest(FolderContent content) {
  const auto manifest = content.find(kManifestFile);
  if (manifest == content.end()) return content;
  auto json = Json::parse(manifest->second, nullptr, false);
  if (!json.is_object()) return content;
  for (const auto* group : {"inputs", "tables"}) {
    if (!json.contains(group) || !json[group].is_object()) continue;
    for (auto& [name, hash] : json[group].items()) {
      const auto file = content.find(std::string{group} + "/" + name);
      if (file != content.end()) hash = sha256(file->second);
    }
  }
  json.erase("checksum");
  manifest->second = sealed_manifest(json.dump());
  return content;
}

}  // namespace kith::fuzzing
