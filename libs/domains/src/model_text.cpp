#include "kith/domains/model_text.hpp"

#include <algorithm>
#include <utility>

namespace kith::detail {
namespace {

constexpr std::size_t kLongestShownLine = 2000;  // bytes; nobody looks at more

// The number of UTF-8 characters.
std::size_t num_characters(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

// Bytes that are not text cannot be shown.
bool is_plain(std::string_view line) {
  return std::all_of(line.begin(), line.end(), [](char c) { return c == '\t' || (c >= 0x20 && c < 0x7F); });
}

void locate(Diagnostic& diagnostic, const ModelPlace& place) {
  if (place.file == nullptr) return;
  const std::string_view text = place.file->text;
  diagnostic.file = place.file->shown;
  const std::size_t at = std::min(place.offset, text.size());
  const std::string_view before = text.substr(0, at);
  const std::size_t last = before.rfind('\n');
  const std::size_t begin = last == std::string_view::npos ? 0 : last + 1;
  const std::size_t end = std::min(text.find_first_of("\r\n", begin), text.size());
  diagnostic.line = 1 + static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n'));
  diagnostic.column = num_characters(text.substr(begin, at - begin)) + 1;
  const std::size_t last_shown = std::min(at + place.length, std::max(end, at));
  diagnostic.length = std::max<std::size_t>(1, num_characters(text.substr(at, last_shown - at)));
  if (end < begin || end - begin > kLongestShownLine) return;
  const std::string_view line = text.substr(begin, end - begin);
  if (!is_image_file(place.file->name) || is_plain(line)) diagnostic.source_line = line;
}

}  // namespace

bool is_image_file(std::string_view name) { return name.ends_with(".pgm") || name.ends_with(".PGM"); }

ModelPlace place_at(const ModelText& file, std::size_t offset) {
  const std::string_view text = file.text;
  const std::size_t begin = std::min(offset, text.size());
  const std::size_t end = std::min(text.find_first_of(" \t\r\n,]}", begin), text.size());
  const bool opens = begin < text.size() && (text[begin] == '[' || text[begin] == '{');
  return {&file, begin, opens ? 1 : std::max<std::size_t>(1, end - begin)};
}

// Beyond the cap errors are only counted: finding the line of each takes as long as the text is.
void ModelReport::add(Diagnostic kind, const ModelPlace& place, std::string id, std::string message, std::string hint) {
  if (kind.severity == Severity::kError && ++num_errors_ > kMaxErrors) return;
  kind.id = std::move(id);
  kind.message = std::move(message);
  kind.hint = std::move(hint);
  locate(kind, place);
  diagnostics_.push_back(std::move(kind));
}

void ModelReport::error(std::string id, const ModelPlace& place, std::string message, std::string hint) {
  add({}, place, std::move(id), std::move(message), std::move(hint));
}

void ModelReport::infeasible(std::string id, const ModelPlace& place, std::string message, std::string hint) {
  add({.infeasible = true}, place, std::move(id), std::move(message), std::move(hint));
}

void ModelReport::warning(std::string id, const ModelPlace& place, std::string message, std::string hint) {
  add({.severity = Severity::kWarning}, place, std::move(id), std::move(message), std::move(hint));
}

void ModelReport::take(std::vector<Diagnostic> diagnostics) {
  for (Diagnostic& diagnostic : diagnostics) {
    if (diagnostic.severity == Severity::kError && ++num_errors_ > kMaxErrors) continue;
    diagnostics_.push_back(std::move(diagnostic));
  }
}

}  // namespace kith::detail
