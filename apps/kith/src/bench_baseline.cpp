#include "bench_baseline.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace kith::cli {
namespace {

constexpr const char* kMend = "write a new one with kith bench --save FILE";

class BaselineReader {
 public:
  BaselineReader(std::string_view text, const std::string& name) : text_{text}, name_{name} {}

  BaselineReading read() {
    try {
      read_document(nlohmann::json::parse(text_));
    } catch (const nlohmann::json::parse_error& error) {
      complain("E1001", "this is not JSON: it ends or breaks here", error.byte > 0 ? error.byte - 1 : 0);
    }
    return std::move(reading_);
  }

 private:
  void read_document(const nlohmann::json& document) {
    const auto schema = document.is_object() ? document.find("schema") : document.end();
    if (schema == document.end() || *schema != kBenchSchema) {
      const std::string found = schema == document.end() ? "no schema" : "the schema " + schema->dump();
      complain("E1002", std::string{"a baseline has the schema \""} + kBenchSchema + "\", and this file has " + found,
               place_of("schema", 0));
      return;
    }
    auto& baseline = reading_.baseline;
    read_text(document, "processor", baseline.processor);
    read_text(document, "build_type", baseline.build_type);
    read_text(document, "compiler", baseline.compiler);
    read_text(document, "git", baseline.git);
    const auto cases = document.find("cases");
    if (cases == document.end() || !cases->is_array()) {
      complain("E1003", "'cases' must be a list", place_of("cases", 0));
      return;
    }
    for (const auto& entry : *cases) read_case(entry);
  }

  void read_text(const nlohmann::json& document, const char* key, std::string& text) {
    const auto found = document.find(key);
    if (found == document.end() || !found->is_string()) {
      complain("E1003", std::string{"'"} + key + "' must be a text", place_of(key, 0));
      return;
    }
    text = found->get<std::string>();
  }

  void read_case(const nlohmann::json& entry) {
    const auto name = entry.is_object() ? entry.find("name") : entry.end();
    if (name == entry.end() || !name->is_string()) {
      complain("E1003", "every entry of 'cases' must have a 'name', a text", place_of("cases", 0));
      return;
    }
    const auto text = name->get<std::string>();
    const auto here = std::min(text_.find(name->dump()), text_.size());
    bench::Figure figure;
    bool good = true;
    for (auto [key, value] : {std::pair{"median", &figure.median}, {"low", &figure.low}, {"high", &figure.high}}) {
      const auto found = entry.find(key);
      if (found != entry.end() && found->is_number() && found->get<double>() > 0.0) {
        *value = found->get<double>();
        continue;
      }
      complain("E1003", std::string{"'"} + key + "' of the case " + text + " must be a number of seconds above 0",
               place_of(key, here));
      good = false;
    }
    if (good) reading_.baseline.cases[text] = figure;
  }

  // Of the key, at or after `from`; else of what is there.
  [[nodiscard]] std::size_t place_of(const std::string& key, std::size_t from) const {
    const auto found = text_.find('"' + key + '"', from);
    return found == std::string_view::npos ? from : found;
  }

  void complain(const char* id, std::string message, std::size_t at) {
    constexpr std::size_t kMost = 20;
    if (reading_.diagnostics.size() == kMost) return;
    at = std::min(at, text_.size());
    const auto before = text_.substr(0, at);
    const auto line_break = before.rfind('\n');
    const auto begin = line_break == std::string_view::npos ? 0 : line_break + 1;
    Diagnostic diagnostic;
    diagnostic.id = id;
    diagnostic.message = std::move(message);
    diagnostic.file = name_;
    diagnostic.line = static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n')) + 1;
    diagnostic.column = at - begin + 1;
    diagnostic.source_line = std::string{text_.substr(begin, text_.find('\n', begin) - begin)};
    diagnostic.hint = kMend;
    reading_.diagnostics.push_back(std::move(diagnostic));
  }

  std::string_view text_;
  std::string name_;
  BaselineReading reading_;
};

}  // namespace

BaselineReading parse_baseline(std::string_view text, const std::string& name) {
  return BaselineReader{text, name}.read();
}

bool is_slower(const bench::Figure& now, const bench::Figure& before, double tolerance) {
  return now.median > before.median * (1.0 + tolerance) && now.low > before.high;
}

}  // namespace kith::cli
