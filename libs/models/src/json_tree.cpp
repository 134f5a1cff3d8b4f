#include "kith/models/json_tree.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <unordered_map>
#include <utility>

namespace kith::detail {
namespace {

using Json = nlohmann::json;

// Walks over a text and says how far the parser has read.
class CountingIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  CountingIterator(const char* at, const char** furthest) : at_{at}, furthest_{furthest} {}
  const char& operator*() const { return *at_; }
  CountingIterator& operator++() {
    ++at_;
    if (furthest_ != nullptr) *furthest_ = at_;
    return *this;
  }
  CountingIterator operator++(int) {
    const CountingIterator before = *this;
    ++*this;
    return before;
  }
  friend bool operator==(const CountingIterator& a, const CountingIterator& b) { return a.at_ == b.at_; }
  friend bool operator!=(const CountingIterator& a, const CountingIterator& b) { return a.at_ != b.at_; }

 private:
  const char* at_;
  const char** furthest_;
};

}  // namespace

// Hears of values one by one as the text is parsed (the SAX interface of nlohmann::json).
class JsonTreeBuilder : public nlohmann::json_sax<Json> {
 public:
  JsonTreeBuilder(const ModelText& file, ModelReport& report) : file_{file}, report_{report} { tree_.file_ = &file; }

  std::optional<JsonTree> run() {
    const char* begin = file_.text.data();
    furthest_ = begin;
    const bool sound = Json::sax_parse(CountingIterator{begin, &furthest_},
                                       CountingIterator{begin + file_.text.size(), nullptr}, this);
    return sound ? std::optional{std::move(tree_)} : std::nullopt;
  }

  bool null() override { return add(JsonTree::Kind::kNull, 0.0); }
  bool boolean(bool value) override { return add(JsonTree::Kind::kBoolean, value ? 1.0 : 0.0); }
  bool number_integer(number_integer_t value) override { return add_number(static_cast<double>(value)); }
  bool number_unsigned(number_unsigned_t value) override { return add_number(static_cast<double>(value)); }
  bool number_float(number_float_t value, const string_t&) override { return add_number(value); }
  bool string(string_t& value) override { return add_string(value); }
  bool binary(binary_t&) override { return false; }  // not in texts
  bool start_object(std::size_t) override { return open(JsonTree::Kind::kObject); }
  bool key(string_t& value) override {
    if (!open_.empty()) {
      const auto [at, is_new] = keys_.back().try_emplace(value, 0);
      if (!is_new) return complain(token_begin(), "key \"" + value + "\" is given twice", "remove one of them");
      ++tree_.nodes_[open_.back()].text;
    }
    return add_string(value);
  }
  bool end_object() override { return close(); }
  bool start_array(std::size_t) override { return open(JsonTree::Kind::kList); }
  bool end_array() override { return close(); }

  bool parse_error(std::size_t position, const std::string&, const Json::exception& exception) override {
    // "[json.exception.parse_error.101] parse error at line 1, column 2: syntax error while ...: what"
    std::string what = exception.what();
    const std::size_t colon = what.find(": ");
    if (colon != std::string::npos) what.erase(0, colon + 2);
    std::replace_if(
        what.begin(), what.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
    return complain(position == 0 ? 0 : position - 1, "this is not valid JSON: " + what,
                    "check it with a JSON validator, or write it with a program");
  }

 private:
  using Kind = JsonTree::Kind;

  // Where the token begins that was just read: behind the one before, and blanks and punctuation.
  [[nodiscard]] std::size_t token_begin() const {
    const std::string_view text = file_.text;
    return std::min(text.find_first_not_of(" \t\r\n,:", behind_), text.size());
  }

  bool complain(std::size_t offset, std::string message, std::string hint) {
    report_.error("E0234", place_at(file_, offset), std::move(message), std::move(hint));
    return false;
  }

  bool add(Kind kind, double number) {
    if (tree_.nodes_.size() == JsonTree::kMaxValues) {
      return complain(token_begin(), "there are more than " + std::to_string(JsonTree::kMaxValues) + " values",
                      "write large models as CSV");
    }
    if (!open_.empty() && tree_.nodes_[open_.back()].kind == Kind::kList) ++tree_.nodes_[open_.back()].text;
    JsonTree::Node node;
    node.kind = kind;
    node.number = number;
    node.offset = static_cast<std::uint32_t>(token_begin());
    node.end = static_cast<std::uint32_t>(tree_.nodes_.size()) + 1;
    tree_.nodes_.push_back(node);
    behind_ = read();
    return true;
  }

  // The parser looks one character beyond the end of a number.
  bool add_number(double value) {
    if (!add(Kind::kNumber, value)) return false;
    if (behind_ > 0 && behind_ <= file_.text.size()) {
      const char last = file_.text[behind_ - 1];
      if (last == ']' || last == '}' || last == ',') --behind_;
    }
    return true;
  }

  bool add_string(const std::string& value) {
    if (!add(Kind::kString, 0.0)) return false;
    tree_.nodes_.back().text = static_cast<std::uint32_t>(tree_.strings_.size());
    tree_.strings_.push_back(value);
    return true;
  }

  bool open(Kind kind) {
    if (open_.size() == JsonTree::kMaxDepth) {
      return complain(token_begin(),
                      "lists and objects are nested deeper than " + std::to_string(JsonTree::kMaxDepth) + " levels",
                      "use a flatter structure");
    }
    if (!add(kind, 0.0)) return false;
    open_.push_back(tree_.nodes_.size() - 1);
    keys_.emplace_back();
    return true;
  }

  bool close() {
    tree_.nodes_[open_.back()].end = static_cast<std::uint32_t>(tree_.nodes_.size());
    open_.pop_back();
    keys_.pop_back();
    behind_ = read();
    return true;
  }

  [[nodiscard]] std::size_t read() const { return static_cast<std::size_t>(furthest_ - file_.text.data()); }

  const ModelText& file_;
  ModelReport& report_;
  JsonTree tree_;
  const char* furthest_ = nullptr;
  std::size_t behind_ = 0;                                   // the end of the last token
  std::vector<std::size_t> open_;                            // lists and objects that are not closed yet
  std::vector<std::unordered_map<std::string, char>> keys_;  // of those
};

std::optional<JsonTree> JsonTree::parse(const ModelText& file, ModelReport& report) {
  return JsonTreeBuilder{file, report}.run();
}

ModelPlace JsonTree::Value::place() const { return place_at(*tree_->file_, node().offset); }

std::string_view JsonTree::Value::kind_name() const {
  static constexpr std::string_view kNames[] = {"null", "true or false", "a number", "a string", "a list", "an object"};
  return kNames[static_cast<std::size_t>(node().kind)];
}

std::optional<JsonTree::Value> JsonTree::Value::find(std::string_view key) const {
  std::optional<Value> found;
  for_each_member([&](const Value& name, const Value& value) {
    if (name.string() == key) found = value;
  });
  return found;
}

}  // namespace kith::detail
