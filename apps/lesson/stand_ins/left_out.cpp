// What a page has no use for: threads, a look at the machine's memory, YAML, and built-in domains and studies.
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "kith/core/memory.hpp"
#include "kith/core/parallel_loop.hpp"
#include "kith/domains/domain_file.hpp"
#include "kith/domains/occupancy_grid.hpp"
#include "kith/files/base64.hpp"

namespace kith {

std::size_t default_num_workers() { return 1; }

void parallel_loop(std::size_t n, std::size_t, const std::function<void(std::size_t worker, std::size_t i)>& body) {
  for (std::size_t i = 0; i < n; ++i) body(0, i);
}

// A page that takes too much is ended by its browser.
std::uint64_t free_memory(const std::filesystem::path&) { return std::numeric_limits<std::uint64_t>::max(); }
std::string memory_text(std::uint64_t bytes) { return std::to_string(bytes) + " bytes"; }
void require_memory(std::uint64_t, const std::string&, const std::string&) {}
void MemoryGuard::check() { unchecked_ = 0; }

const std::vector<BuiltInDomain>& built_in_domains() {
  static const std::vector<BuiltInDomain> kNone;
  return kNone;
}

std::string base64(std::string_view bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t k = i; k < i + 3; ++k)
      three = three << 8 | (k < bytes.size() ? static_cast<unsigned char>(bytes[k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? kDigits[three >> (18 - 6 * k) & 63u] : '=';
  }
  return text;
}

namespace detail {

// `kith lesson` has written it as JSON.
std::optional<YamlTable> read_yaml_table(const ModelText& file, ModelReport& report) {
  const auto json = nlohmann::json::parse(file.text, nullptr, false);
  YamlTable table;
  for (const auto& [key, value] : json.items()) {
    if (value.is_array()) table[key] = {value.get<std::vector<std::string>>(), true};
    if (value.is_string()) table[key] = {{value.get<std::string>()}};
  }
  if (!json.is_object()) report.error("E0268", place_at(file, 0), "the grid is not as kith lesson writes it");
  return json.is_object() ? std::optional{table} : std::nullopt;
}

// The study of a page is a file.
extern const std::string_view kQuickText, kPaperText, kPaperUncalibratedText;
const std::string_view kQuickText, kPaperText, kPaperUncalibratedText;

}  // namespace detail
}  // namespace kith
