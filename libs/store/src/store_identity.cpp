#include "store_identity.hpp"

#include <charconv>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "kith/core/error.hpp"
#include "kith/files/atomic_file.hpp"
#include "kith/files/bytes.hpp"
#include "kith/files/sha256.hpp"
#include "kith/store/random_token.hpp"

namespace kith {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kIdBytes = 16;
constexpr std::string_view kInput = "input/";

std::string checksum(const std::map<std::string, std::string>& meta) {
  ByteWriter text;
  for (const auto& [key, value] : meta) {
    if (key == "checksum") continue;
    text.text(key);
    text.text(value);
  }
  return sha256(text.bytes());
}

std::optional<std::int64_t> number_of(const std::string& text) {
  std::int64_t value = 0;
  const auto* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  return error == std::errc{} && rest == end ? std::optional{value} : std::nullopt;
}

}  // namespace

std::string new_store_id() { return sha256(random_bytes(kIdBytes)).substr(0, 2 * kIdBytes); }

std::map<std::string, std::string> to_meta(const StoreFacts& facts) {
  std::map<std::string, std::string> meta{{"schema", kStoreSchema},
                                          {"id", facts.id},
                                          {"study", facts.identity.study},
                                          {"program", facts.identity.program},
                                          {"created_us", std::to_string(facts.created_us)}};
  for (const auto& [name, text] : facts.identity.inputs) meta.emplace(std::string{kInput} + name, text);
  meta.emplace("checksum", checksum(meta));
  return meta;
}

std::optional<StoreFacts> from_meta(const std::map<std::string, std::string>& meta) {
  const auto find = [&](const char* key) {
    const auto found = meta.find(key);
    return found == meta.end() ? std::string{} : found->second;
  };
  const auto created = number_of(find("created_us"));
  if (find("schema") != kStoreSchema || find("checksum") != checksum(meta) || !created) return std::nullopt;
  StoreFacts facts{.identity = {.study = find("study"), .program = find("program"), .inputs = {}},
                   .id = find("id"),
                   .created_us = *created};
  for (const auto& [key, value] : meta) {
    if (key.compare(0, kInput.size(), kInput) == 0) facts.identity.inputs.emplace(key.substr(kInput.size()), value);
  }
  return facts;
}

void write_identity_file(const fs::path& folder, const StoreFacts& facts) {
  nlohmann::ordered_json document;
  for (const auto& [key, value] : to_meta(facts)) document[key] = value;
  write_file_atomically(folder / kIdentityFile, document.dump(2) + "\n", FolderSync::kNow, OldLink::kReplace);
}

std::optional<StoreFacts> read_identity_file(const fs::path& folder) {
  std::error_code none;
  if (!fs::is_regular_file(folder / kIdentityFile, none)) return std::nullopt;
  const auto document = nlohmann::json::parse(read_file(folder / kIdentityFile), nullptr, false);
  if (!document.is_object()) return std::nullopt;
  std::map<std::string, std::string> meta;
  for (const auto& [key, value] : document.items()) {
    if (value.is_string()) meta.emplace(key, value.get<std::string>());
  }
  return from_meta(meta);
}

}  // namespace kith
