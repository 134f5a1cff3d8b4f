#include "kith/domains/layers.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include "kith/domains/occupancy_grid.hpp"

namespace kith::detail {
namespace {

constexpr int kNothing = -1;
constexpr std::int64_t kMostPixelsPerCell = 1'000;

// The character in quotes, or its code if it cannot be seen.
std::string shown(char c) {
  static constexpr char kHex[] = "0123456789ABCDEF";
  const auto byte = static_cast<unsigned char>(c);
  if (byte >= 0x20 && byte < 0x7F) return std::string{"'"}.append(1, c).append("'");
  return std::string{"0x"}.append(1, kHex[byte >> 4U]).append(1, kHex[byte & 0xFU]);
}

std::size_t cells_of(std::size_t pixels, std::size_t pixels_per_cell) {
  return (pixels + pixels_per_cell - 1) / pixels_per_cell;
}

// visit(x, y, cell) for every pixel of an image.
template <typename Visit>
void for_each_pixel(std::size_t width, std::size_t height, std::size_t pixels_per_cell, const Visit& visit) {
  const std::size_t columns = cells_of(width, pixels_per_cell);
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < width; ++x) visit(x, y, y / pixels_per_cell * columns + x / pixels_per_cell);
  }
}

}  // namespace

GreyImage scaled_down(const GreyImage& image, std::size_t n) {
  if (n == 1) return image;
  GreyImage small{cells_of(image.width, n), cells_of(image.height, n), image.white, {}};
  small.grey.assign(small.width * small.height, 0);
  std::array<std::size_t, 256> number{};
  for (std::size_t cell = 0; cell < small.grey.size(); ++cell) {
    number.fill(0);
    const std::size_t top = cell / small.width * n;
    const std::size_t left = cell % small.width * n;
    for (std::size_t y = top; y < std::min(top + n, image.height); ++y) {
      for (std::size_t x = left; x < std::min(left + n, image.width); ++x) ++number[image.at(x, y)];
    }
    small.grey[cell] = static_cast<std::uint8_t>(std::max_element(number.begin(), number.end()) - number.begin());
  }
  return small;
}

bool LayersReader::read_base(TomlReader& map) {
  const auto pixels = map.integer("pixels_per_cell", Presence::kOptional, {1, kMostPixelsPerCell});
  pixels_per_cell_ = static_cast<std::size_t>(pixels.value_or(1));
  const auto drawing = read_drawing(map, true);
  if (!drawing) {
    map.know("layer");
    return false;
  }
  family_map_.source_place = drawing->place;
  family_map_.width = static_cast<int>(drawing->width);
  family_map_.height = static_cast<int>(drawing->height);
  if (drawing->rows != nullptr) {
    for (const TomlValue& row : *drawing->rows) family_map_.row_places.push_back(row.place());
  }
  family_map_.symbol_of.reserve(drawing->symbols.size());
  for (const int symbol : drawing->symbols)
    family_map_.symbol_of.push_back(static_cast<std::uint8_t>(std::max(symbol, 0)));
  if (family_map_.symbols.empty()) family_map_.symbols.emplace_back();
  return true;
}

void LayersReader::read_others(TomlReader& map) {
  const TomlArray* layers = map.array("layer", Presence::kOptional);
  if (layers == nullptr) return;
  for (const TomlValue& layer : *layers) {
    if (read_table(layer, "a layer", report_) == nullptr) continue;
    read_layer(layer);
    ++num_others_;
  }
}

void LayersReader::read_layer(const TomlValue& value) {
  TomlReader layer{*value.table(), value.place(), "[[map.layer]]", report_};
  std::optional<std::string> toggle;
  if (const TomlValue* optional = layer.value("optional", Presence::kOptional)) {
    const bool* flag = optional->boolean();
    const std::string* name = optional->string();
    const bool is_name =
        name != nullptr && !name->empty() && (family_map_.is_picture || std::ranges::all_of(*name, is_name_character));
    if (flag == nullptr && name == nullptr) {
      report_.error("E0108", optional->place(),
                    "optional must be true or a name, not " + std::string{optional->kind_name()});
    } else if (name != nullptr && !is_name) {
      report_.error("E0225", optional->place(), "'" + *name + "' cannot be a name", "use letters, digits, '_' and '-'");
    } else if (name != nullptr) {
      toggle = *name;
    } else if (*flag) {
      toggle = "";
    }
  }

  std::size_t column = 1;
  std::size_t row = 1;
  if (const TomlArray* at = layer.array("at", Presence::kOptional)) {
    const IntegerRange range{1, static_cast<std::int64_t>(kMaxCells)};
    std::vector<std::size_t> numbers;
    for (const TomlValue& element : *at) {
      if (const auto n = read_integer(element, "every element of 'at'", range, report_)) {
        numbers.push_back(static_cast<std::size_t>(*n));
      }
    }
    if (at->size() != 2) {
      report_.error("E0265", layer.content().find("at")->place(), "'at' is the column and the row of a cell",
                    "for instance at = [3, 2]; both are counted from 1, from the top left corner");
    }
    if (at->size() != 2 || numbers.size() != 2) {
      for (const char* key : {"rows", "image", "grey"}) layer.know(key);
      return layer.finish();
    }
    column = numbers[0];
    row = numbers[1];
  }

  const auto drawing = read_drawing(layer, false);
  layer.finish();
  if (drawing) paint(*drawing, column, row, toggle);
}

void LayersReader::paint(const Drawing& drawing, std::size_t column, std::size_t row,
                         const std::optional<std::string>& toggle) {
  const auto width = static_cast<std::size_t>(family_map_.width);
  const auto height = static_cast<std::size_t>(family_map_.height);
  if (column - 1 + drawing.width > width || row - 1 + drawing.height > height) {
    const auto size = [](std::size_t w, std::size_t h) { return std::to_string(w) + " x " + std::to_string(h); };
    report_.error("E0265", drawing.place,
                  "a layer of " + size(drawing.width, drawing.height) + " cells at (" + std::to_string(column) + "," +
                      std::to_string(row) + ") does not fit on the map of " + size(width, height),
                  "a layer is as large as the map, or a smaller one is placed with at = [COLUMN, ROW]");
    return;
  }
  bool said = false;
  for (std::size_t i = 0; i < drawing.symbols.size(); ++i) {
    if (drawing.symbols[i] < 0) continue;
    const std::size_t x = i % drawing.width;
    const std::size_t y = i / drawing.width;
    const auto symbol = static_cast<std::uint8_t>(drawing.symbols[i]);
    if (family_map_.symbols[symbol].content.is_floor()) continue;
    TomlPlace place = drawing.place;
    if (drawing.rows != nullptr) place = report_.document().inside((*drawing.rows)[y], x);
    if (toggle && family_map_.symbols[symbol].is_optional() && !said) {
      report_.error("E0213", place,
                    std::string{"symbol '"} + family_map_.symbols[symbol].glyph + "' is optional, and so is the layer",
                    "leave out one of the two");
      said = true;
    }
    painted_.push_back({{(row - 1 + y) * width + column - 1 + x, symbol, -1}, num_others_, toggle, place});
  }
}

// One of `rows`, `image` and, for the lowest layer, `occupancy`.
std::optional<LayersReader::Drawing> LayersReader::read_drawing(TomlReader& layer, bool is_base) {
  const bool has_rows = layer.has("rows");
  const bool has_image = layer.has("image");
  const bool has_grid = is_base && layer.has("occupancy");
  const int number = (has_rows ? 1 : 0) + (has_image ? 1 : 0) + (has_grid ? 1 : 0);
  if (number == 0) {
    report_.error("E0109", layer.place(), "key 'rows' is missing in " + layer.name(),
                  is_base ? "write rows, image = \"FILE.pgm\" or occupancy = \"FILE.yaml\""
                          : "write rows, or image = \"FILE.pgm\"");
  } else if (number > 1) {
    report_.error("E0265", layer.place(), layer.name() + " is drawn twice",
                  "keep one of the keys rows, image and occupancy");
  }
  if (number != 1) {
    for (const char* key : {"grey", "unknown"}) layer.know(key);
    return std::nullopt;
  }
  if (has_rows) return read_rows(*layer.value("rows", Presence::kRequired), is_base);
  return has_image ? read_image(layer, is_base) : read_occupancy(layer);
}

// --- text ---

// A character outside ASCII is several bytes, so lengths cannot be compared before it is mended.
bool LayersReader::has_other_characters(const TomlArray& rows) {
  constexpr unsigned char kLastAscii = 0x7F;
  bool found = false;
  for (const TomlValue& row : rows) {
    if (row.string() == nullptr) continue;
    const auto& text = *row.string();
    const auto other =
        std::find_if(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) > kLastAscii; });
    if (other == text.end()) continue;
    found = true;
    report_.error("E0203", report_.document().inside(row, static_cast<std::size_t>(other - text.begin())),
                  "this row contains a non-ASCII character", "use one ASCII character per cell");
  }
  return found;
}

bool LayersReader::check_shape(const TomlValue& value, const TomlArray& rows) {
  const std::size_t errors_before = report_.num_errors();
  if (rows.empty()) report_.error("E0201", value.place(), "the map has no rows");
  if (has_other_characters(rows)) return false;
  for (const TomlValue& row : rows) {
    if (!read_string(row, "a row of the map", report_)) continue;
    const std::size_t width = rows.front().string() == nullptr ? 0 : rows.front().string()->size();
    if (row.string()->empty()) {
      report_.error("E0201", row.place(), "a row of the map is empty");
    } else if (rows.front().string() != nullptr && row.string()->size() != width) {
      report_.error(
          "E0202", row.place(),
          "this row has " + std::to_string(row.string()->size()) + " cells, the first one has " + std::to_string(width),
          "all rows must have the same length, with one ASCII character per cell");
    }
  }
  return report_.num_errors() == errors_before && check_size(rows.front().string()->size(), rows.size(), value.place());
}

bool LayersReader::check_size(std::size_t width, std::size_t height, const TomlPlace& place) {
  if (width * height <= kMaxCells) return true;
  report_.error("E0217", place, "the map has " + std::to_string(width * height) + " cells; at most 1000000 are read",
                "use a smaller map, or more pixels_per_cell of an image");
  return false;
}

std::optional<LayersReader::Drawing> LayersReader::read_rows(const TomlValue& value, bool is_base) {
  const TomlArray* rows = read_array(value, "'rows'", report_);
  if (rows == nullptr || !check_shape(value, *rows)) return std::nullopt;
  Drawing drawing{rows->front().string()->size(), rows->size(), {}, rows, value.place()};
  std::array<int, 256> number{};
  number.fill(-1);
  for (std::size_t i = 0; i < family_map_.symbols.size(); ++i) {
    number[static_cast<unsigned char>(family_map_.symbols[i].glyph)] = static_cast<int>(i);
  }
  for (const TomlValue& row : *rows) {
    const std::string& text = *row.string();
    for (std::size_t x = 0; x < text.size(); ++x) {
      int& symbol = number[static_cast<unsigned char>(text[x])];
      if (symbol == -1 && !is_base && text[x] == ' ') symbol = -3;  // nothing is painted
      if (symbol == -1) {
        report_.error("E0203", report_.document().inside(row, x),
                      "symbol " + shown(text[x]) + " is not declared in [map.legend]", suggestion_for_undeclared());
        symbol = -2;  // once per symbol
      }
      drawing.symbols.push_back(symbol == -2 ? (is_base ? 0 : kNothing) : std::max(symbol, kNothing));
    }
  }
  return drawing;
}

std::string LayersReader::suggestion_for_undeclared() const {
  std::string hint = "declared:";
  for (const Symbol& symbol : family_map_.symbols) hint += std::string{" '"} + symbol.glyph + "'";
  return family_map_.symbols.empty() ? "" : hint;
}

int LayersReader::symbol_with(char glyph) const {
  for (std::size_t i = 0; i < family_map_.symbols.size(); ++i) {
    if (family_map_.symbols[i].glyph == glyph) return static_cast<int>(i);
  }
  return kNothing;
}

// --- images ---

// grey = { 64 = "z" }: symbols by grey; white is floor, or nothing in a layer, unless it is listed.
std::optional<std::vector<int>> LayersReader::read_grey(TomlReader& layer, const GreyImage& image, bool is_base) {
  constexpr int kUnlisted = -2;
  std::vector<int> symbols(256, kUnlisted);
  symbols[image.white] = is_base ? plain_symbol(false) : kNothing;
  auto table = layer.table("grey", Presence::kRequired);
  if (!table) return std::nullopt;
  const std::size_t errors_before = report_.num_errors();
  for (const TomlEntry& entry : table->content().entries()) {
    unsigned grey = 0;
    const auto [end, error] = std::from_chars(entry.key.data(), entry.key.data() + entry.key.size(), grey);
    if (error != std::errc{} || end != entry.key.data() + entry.key.size() || grey > image.white) {
      report_.error("E0269", entry.place,
                    "'" + entry.key + "' is no grey value of this image, whose values are 0 (black) to " +
                        std::to_string(image.white) + " (white)",
                    "write GREY = \"SYMBOL\", for instance 128 = \"s\"");
      continue;
    }
    const auto text = read_string(entry.value, "a symbol", report_);
    if (!text) continue;
    symbols[grey] = text->size() == 1 ? symbol_with(text->front()) : kNothing;
    if (symbols[grey] != kNothing) continue;
    report_.error("E0269", entry.value.place(), "'" + *text + "' is not a symbol of [map.legend]",
                  suggestion_for_undeclared());
  }

  if (report_.num_errors() > errors_before) return std::nullopt;
  std::vector<int> result;
  result.reserve(image.grey.size());
  for (const std::uint8_t grey : image.grey) {
    if (symbols[grey] == kUnlisted) {
      const std::size_t at = result.size();
      report_.error("E0269", table->place(),
                    "grey " + std::to_string(grey) + " has no symbol; it is at cell (" +
                        std::to_string(at % image.width + 1) + "," + std::to_string(at / image.width + 1) + ")",
                    "add " + std::to_string(grey) + " = \"SYMBOL\"; only white, " + std::to_string(image.white) +
                        ", may be left out");
      return std::nullopt;
    }
    result.push_back(symbols[grey]);
  }
  return result;
}

std::optional<LayersReader::Drawing> LayersReader::read_image(TomlReader& layer, bool is_base) {
  layer.know("grey");
  const auto name = layer.string("image", Presence::kRequired);
  const TomlPlace place = layer.content().find("image")->place();
  const ModelText* text = name ? files_.open(*name, place, image_files()) : nullptr;
  const auto image = text == nullptr ? std::nullopt : read_pgm(*text, model_report_);
  if (!image) return std::nullopt;
  const GreyImage cells = scaled_down(*image, pixels_per_cell_);
  if (!check_size(cells.width, cells.height, place)) return std::nullopt;
  auto symbols = read_grey(layer, cells, is_base);
  if (!symbols) return std::nullopt;
  return Drawing{cells.width, cells.height, *std::move(symbols), nullptr, place};
}

// The symbol of the legend that is nothing but floor or wall; one is added if there is none.
int LayersReader::plain_symbol(bool wall) {
  SymbolContent content;
  content.wall = wall;
  for (std::size_t i = 0; i < family_map_.symbols.size(); ++i) {
    if (family_map_.symbols[i].content == content && !family_map_.symbols[i].is_optional()) return static_cast<int>(i);
  }
  Symbol symbol;
  symbol.glyph = unused_glyph(family_map_, wall ? "#X" : "._").value_or(wall ? '#' : '.');
  symbol.content = content;
  symbol.place = family_map_.map_place;
  family_map_.symbols.push_back(std::move(symbol));
  return static_cast<int>(family_map_.symbols.size() - 1);
}

std::optional<LayersReader::Drawing> LayersReader::read_occupancy(TomlReader& map) {
  const auto unknown = map.word("unknown", Presence::kOptional, {"wall", "floor"});
  const auto name = map.string("occupancy", Presence::kRequired);
  const TomlPlace place = map.content().find("occupancy")->place();
  const ModelText* yaml = name ? files_.open(*name, place, occupancy_files()) : nullptr;
  const auto grid = yaml == nullptr ? std::nullopt : read_occupancy_grid(*yaml, place, files_, model_report_);
  if (!grid) return std::nullopt;
  const std::size_t width = cells_of(grid->width, pixels_per_cell_);
  const std::size_t height = cells_of(grid->height, pixels_per_cell_);
  if (!check_size(width, height, place)) return std::nullopt;
  // A cell is as safe as the worst of its pixels.
  std::vector<bool> is_wall(width * height, false);
  for_each_pixel(grid->width, grid->height, pixels_per_cell_, [&](std::size_t x, std::size_t y, std::size_t cell) {
    const Occupancy pixel = grid->pixels[y * grid->width + x];
    const bool blocked = pixel == Occupancy::kOccupied || (pixel == Occupancy::kUnknown && unknown != std::size_t{1});
    if (blocked) is_wall[cell] = true;
  });
  const int wall = plain_symbol(true);
  const int floor = plain_symbol(false);
  Drawing drawing{width, height, {}, nullptr, place};
  for (const bool blocked : is_wall) drawing.symbols.push_back(blocked ? wall : floor);
  return drawing;
}

}  // namespace kith::detail
