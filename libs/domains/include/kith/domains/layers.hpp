#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kith/domains/family_map.hpp"
#include "kith/domains/grey_image.hpp"
#include "kith/domains/named_files.hpp"

namespace kith::detail {

// A thing of a layer above the lowest one.
struct PaintedThing {
  MapThing thing;                     // its group is not known yet
  std::size_t layer = 0;              // from 0
  std::optional<std::string> toggle;  // of the layer, if it is optional; empty: the layer by itself
  TomlPlace place;
};

// Reads what [map] and [[map.layer]] draw: text, an occupancy grid or an image.
class LayersReader {
 public:
  LayersReader(FamilyMap& family_map, TomlReport& report, NamedFiles& files, ModelReport& model_report)
      : family_map_{family_map}, report_{report}, files_{files}, model_report_{model_report} {}

  // The lowest layer. False after reporting what is wrong, if nothing else can be said about the map.
  [[nodiscard]] bool read_base(TomlReader& map);
  void read_others(TomlReader& map);

  // By layer, and in reading order within each.
  [[nodiscard]] std::vector<PaintedThing>& painted() { return painted_; }
  [[nodiscard]] std::size_t num_others() const { return num_others_; }

 private:
  // Symbols of cells; -1: nothing is drawn there.
  struct Drawing {
    std::size_t width = 0;
    std::size_t height = 0;
    std::vector<int> symbols;
    const TomlArray* rows = nullptr;  // where it is text
    TomlPlace place;
  };

  [[nodiscard]] std::optional<Drawing> read_drawing(TomlReader& layer, bool is_base);
  [[nodiscard]] std::optional<Drawing> read_rows(const TomlValue& value, bool is_base);
  [[nodiscard]] std::optional<Drawing> read_image(TomlReader& layer, bool is_base);
  [[nodiscard]] std::optional<Drawing> read_occupancy(TomlReader& map);
  [[nodiscard]] bool check_shape(const TomlValue& value, const TomlArray& rows);
  [[nodiscard]] bool has_other_characters(const TomlArray& rows);
  [[nodiscard]] bool check_size(std::size_t width, std::size_t height, const TomlPlace& place);
  [[nodiscard]] std::optional<std::vector<int>> read_grey(TomlReader& layer, const GreyImage& image, bool is_base);
  void read_layer(const TomlValue& value);
  void paint(const Drawing& drawing, std::size_t column, std::size_t row, const std::optional<std::string>& toggle);
  [[nodiscard]] std::string suggestion_for_undeclared() const;
  [[nodiscard]] int symbol_with(char glyph) const;
  [[nodiscard]] int plain_symbol(bool wall);

  FamilyMap& family_map_;
  TomlReport& report_;
  NamedFiles& files_;
  ModelReport& model_report_;
  std::size_t pixels_per_cell_ = 1;
  std::vector<PaintedThing> painted_;
  std::size_t num_others_ = 0;
};

// The largest map.
inline constexpr std::size_t kMaxCells = 1'000'000;

// The cells of an image in which a cell has n x n pixels, and the most frequent grey of each, the darkest of several.
[[nodiscard]] GreyImage scaled_down(const GreyImage& image, std::size_t n);

// Reads [[map.raster]], and makes each known as a place that conditions can name: where its value is not 0.
void read_rasters(TomlReader& map, FamilyMap& family_map, NamedFiles& files, TomlReport& report,
                  ModelReport& model_report);

// The values of all rasters in all MDPs. Distances are steps of a robot that goes around walls; with kSeen a straight
// line between the centres of two cells must not go through a wall (Bresenham's cells between them).
void compute_rasters(FamilyMap& family_map, TomlReport& report);

// A character that no symbol has yet; nothing if there is none left.
[[nodiscard]] std::optional<char> unused_glyph(const FamilyMap& family_map, std::string_view preferred);

// Gives every combination of things that can share a cell a symbol, so that it can be drawn.
void name_combinations(FamilyMap& family_map);

}  // namespace kith::detail
