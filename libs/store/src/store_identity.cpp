#include "store_identity.hpp"

#include <charconv>
#include <system_error>
#include <utility>

#include "kith/files/bytes.hpp"
#include "kith/files/sha256.hpp"
#include "kith/store/random_token.hpp"

namespace kith {
namespace {

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

}  // namespace kith
