#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kith/models/model_text.hpp"

namespace kith::detail {

// A JSON text in which every value knows where it stands. Values lie one after the other in the order of the text, the
// parts of a list or an object right behind it, so a text of millions of numbers takes 24 bytes for each.
class JsonTree {
 public:
  enum class Kind : std::uint8_t { kNull, kBoolean, kNumber, kString, kList, kObject };

 private:
  struct Node {
    double number = 0.0;       // or whether it is true
    std::uint32_t text = 0;    // of a string: which; of a list or object: how many parts
    std::uint32_t end = 0;     // the index behind all of its parts
    std::uint32_t offset = 0;  // in the text
    Kind kind = Kind::kNull;
  };

 public:
  static constexpr std::size_t kMaxDepth = 16;
  static constexpr std::size_t kMaxValues = 8'000'000;

  // Nothing after reporting what is wrong.
  [[nodiscard]] static std::optional<JsonTree> parse(const ModelText& file, ModelReport& report);

  // One value of a tree, which must outlive it.
  class Value {
   public:
    Value(const JsonTree& tree, std::size_t index) : tree_{&tree}, index_{index} {}
    [[nodiscard]] Kind kind() const { return node().kind; }
    [[nodiscard]] bool is(Kind kind) const { return node().kind == kind; }
    [[nodiscard]] bool boolean() const { return node().number != 0.0; }
    [[nodiscard]] double number() const { return node().number; }
    [[nodiscard]] const std::string& string() const { return tree_->strings_[node().text]; }
    // The number of elements or members.
    [[nodiscard]] std::size_t size() const { return node().text; }
    [[nodiscard]] ModelPlace place() const;
    // "a number", "a list", ...
    [[nodiscard]] std::string_view kind_name() const;

    // visit(element) for those of a list; none of anything else.
    template <typename Visit>
    void for_each_element(const Visit& visit) const {
      if (!is(Kind::kList)) return;
      for (std::size_t i = index_ + 1; i < node().end; i = tree_->nodes_[i].end) visit(Value{*tree_, i});
    }
    // visit(key, value) for those of an object. The key is a string with a place.
    template <typename Visit>
    void for_each_member(const Visit& visit) const {
      if (!is(Kind::kObject)) return;
      for (std::size_t i = index_ + 1; i < node().end; i = tree_->nodes_[i + 1].end) {
        visit(Value{*tree_, i}, Value{*tree_, i + 1});
      }
    }
    // The value of a key of an object.
    [[nodiscard]] std::optional<Value> find(std::string_view key) const;

   private:
    friend class JsonTree;
    [[nodiscard]] const Node& node() const { return tree_->nodes_[index_]; }
    const JsonTree* tree_;
    std::size_t index_;
  };

  [[nodiscard]] Value root() const { return {*this, 0}; }

 private:
  friend class JsonTreeBuilder;
  const ModelText* file_ = nullptr;
  std::vector<Node> nodes_;
  std::vector<std::string> strings_;
};

}  // namespace kith::detail
