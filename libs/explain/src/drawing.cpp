#include "drawing.hpp"

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>

#include "kith/core/assert.hpp"
#include "kith/explain/json.hpp"

namespace kith::detail {
namespace {

struct Drawing {
  std::vector<Tint> tints;
  std::vector<Texture> textures;
  std::vector<Icon> icons;
  std::vector<std::pair<std::string, std::string>> colors;
};

Drawing read() {
  const auto json = Json::parse(kDrawingText);
  Drawing drawing;
  for (const auto& tint : json.at("tints")) {
    drawing.tints.push_back({tint.at("name"), tint.at("ground").at(0), tint.at("mark").at(0), tint.at("terrains"),
                             tint.value("only_named", false)});
  }
  for (const auto& texture : json.at("textures")) {
    drawing.textures.push_back({texture.at("name"), texture.at("path"), texture.at("at"), texture.at("filled")});
  }
  for (const auto& icon : json.at("icons")) {
    drawing.icons.push_back({icon.at("words"), icon.value("fill", ""), icon.value("line", "")});
  }
  for (const auto& [name, pair] : json.at("colors").items()) drawing.colors.emplace_back(name, pair.at(0));
  return drawing;
}

const Drawing& drawing() {
  static const Drawing kDrawing = read();
  return kDrawing;
}

// In lower case.
std::vector<std::string> words_of(std::string_view name) {
  std::vector<std::string> words(1);
  for (const char c : name) {
    if (std::isalpha(static_cast<unsigned char>(c)) != 0) {
      words.back() += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    } else if (!words.back().empty()) {
      words.emplace_back();
    }
  }
  return words;
}

}  // namespace

const std::vector<Tint>& tints() { return drawing().tints; }

const std::vector<Texture>& textures() { return drawing().textures; }

const Icon* icon_of(std::string_view name) {
  const auto words = words_of(name);
  for (const auto& icon : drawing().icons) {
    if (std::ranges::find_first_of(icon.words, words) != icon.words.end()) return &icon;
  }
  return nullptr;
}

const std::string& board_color(std::string_view name) {
  const auto& colors = drawing().colors;
  const auto at = std::ranges::find(colors, name, [](const auto& color) -> std::string_view { return color.first; });
  KITH_ASSERT(at != colors.end());
  return at->second;
}

}  // namespace kith::detail
