#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

// How terrains and things are drawn, the same in pictures and on pages: web/src/shared/board/drawing.json.
namespace kith::detail {

extern const std::string_view kDrawingText;

/// Colours of a terrain, light.
struct Tint {
  std::string name, ground, mark;
  std::vector<std::string> terrains;  ///< That have it by their names.
  bool only_named = false;            ///< Given to no other terrain.
};

/// What is drawn on a tile of 10 by 10.
struct Texture {
  std::string name, path;  ///< A path from each of the places.
  std::vector<std::array<double, 2>> at;
  bool is_filled = false;
};

/// A picture of a thing around (0, 0), 16 wide: a path that is filled or drawn as a line.
struct Icon {
  std::vector<std::string> words;  ///< Of names.
  std::string fill, line;
};

[[nodiscard]] const std::vector<Tint>& tints();
[[nodiscard]] const std::vector<Texture>& textures();
/// Null: the thing is drawn as a letter.
[[nodiscard]] const Icon* icon_of(std::string_view name);
/// "wall", "ink" and so on, on light ground.
[[nodiscard]] const std::string& board_color(std::string_view name);

}  // namespace kith::detail
