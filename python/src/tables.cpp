// Tables of a run, column by column: numbers in memory that arrays look at, texts as lists.
#include <limits>
#include <memory>
#include <utility>

#include "arrays.hpp"
#include "kith/core/error.hpp"
#include "kith/core/text.hpp"
#include "kith/files/codebook.hpp"
#include "kith/files/csv_reader.hpp"
#include "kith/files/published_run.hpp"
#include "waiting.hpp"

namespace kith::python {
namespace {

struct Cells {
  Column column;
  bool has_gaps = false;
  std::vector<double> reals;
  std::vector<std::int64_t> integers;
  std::vector<std::uint8_t> booleans;
  std::vector<std::string> texts;
  std::vector<bool> is_missing;
};

struct Table {
  TableDescription description;
  std::size_t num_rows = 0;
  std::vector<std::shared_ptr<Cells>> columns;
};

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

void take(Cells& cells, const TableCell& cell) {
  const bool missing = std::holds_alternative<std::monostate>(cell);
  cells.has_gaps = cells.has_gaps || missing;
  cells.is_missing.push_back(missing);
  switch (cells.column.type) {
    case ColumnType::kReal:
      cells.reals.push_back(missing ? kNaN : std::get<double>(cell));
      break;
    case ColumnType::kInteger:
      cells.integers.push_back(missing ? 0 : std::get<std::int64_t>(cell));
      break;
    case ColumnType::kBoolean:
      cells.booleans.push_back(!missing && std::get<bool>(cell) ? 1 : 0);
      break;
    case ColumnType::kText:
      cells.texts.push_back(missing ? std::string{} : std::get<std::string>(cell));
      break;
  }
}

// Whole numbers with gaps are real ones, since only these have NaN.
void fill_gaps(Cells& cells) {
  if (!cells.has_gaps || cells.column.type != ColumnType::kInteger) return;
  for (std::size_t i = 0; i < cells.integers.size(); ++i)
    cells.reals.push_back(cells.is_missing[i] ? kNaN : static_cast<double>(cells.integers[i]));
  cells.integers.clear();
  cells.column.type = ColumnType::kReal;
}

Table read_table(const std::string& folder, const std::string& name) {
  const auto run = PublishedRun::open(folder);
  const auto book = run.folder() / "tables" / "codebook.json";
  Table table;
  bool found = false;
  std::vector<std::string> names;
  for (auto& one : read_codebook(run.read("tables/codebook.json"), book.string())) {
    names.push_back(one.file.substr(0, one.file.rfind('.')));
    if (one.file != name + ".csv") continue;
    table.description = std::move(one);
    found = true;
  }
  if (!found) throw Error{ErrorKind::kUsage, "the run has no table '" + name + "', only " + joined(names)};
  for (const auto& column : table.description.columns) {
    table.columns.push_back(std::make_shared<Cells>());
    table.columns.back()->column = column;
  }
  const auto file = (run.folder() / "tables" / (name + ".csv")).string();
  const auto faults =
      read_csv(run.read("tables/" + name + ".csv"), file, table.description.columns, [&](const CsvRow& row) {
        ++table.num_rows;
        for (std::size_t i = 0; i < row.cells.size(); ++i) take(*table.columns[i], row.cells[i]);
      });
  if (has_errors(faults)) throw Error{faults};
  for (auto& cells : table.columns) fill_gaps(*cells);
  return table;
}

py::object array_of(const std::shared_ptr<Cells>& cells) {
  const auto& own = *cells;
  const auto rows = static_cast<py::ssize_t>(own.is_missing.size());
  switch (own.column.type) {
    case ColumnType::kReal:
      return as_array(Array{cells, own.reals.data(), 'd', {rows}, {8}});
    case ColumnType::kInteger:
      return as_array(Array{cells, own.integers.data(), 'q', {rows}, {8}});
    case ColumnType::kBoolean:
      if (!own.has_gaps) return as_array(Array{cells, own.booleans.data(), '?', {rows}, {1}});
      break;
    case ColumnType::kText:
      break;
  }
  py::list list;
  for (std::size_t i = 0; i < own.is_missing.size(); ++i) {
    if (own.is_missing[i]) {
      list.append(py::none());
    } else if (own.column.type == ColumnType::kBoolean) {
      list.append(own.booleans[i] != 0);
    } else {
      list.append(own.texts[i]);
    }
  }
  return list;
}

}  // namespace

void bind_tables(py::module_& module) {
  py::class_<Table, std::shared_ptr<Table>>(module, "Table", "A table of a run, in memory.")
      .def(py::init([](const std::string& folder, const std::string& name) {
             return std::make_shared<Table>(wait_for([&] { return read_table(folder, name); }));
           }),
           py::arg("folder"), py::arg("name"))
      .def("__len__", [](const Table& self) { return self.num_rows; })
      .def_property_readonly("description", [](const Table& self) { return self.description.description; })
      .def_property_readonly("columns",
                             [](const Table& self) {
                               py::list names;
                               for (const auto& cells : self.columns) names.append(cells->column.name);
                               return names;
                             })
      .def_property_readonly("codebook",
                             [](const Table& self) {
                               py::list rows;
                               for (const auto& column : self.description.columns)
                                 rows.append(py::make_tuple(column.name, std::string{to_string(column.type)},
                                                            column.unit, column.description));
                               return rows;
                             })
      .def(
          "column",
          [](const Table& self, const std::string& name) {
            for (const auto& cells : self.columns) {
              if (cells->column.name == name) return array_of(cells);
            }
            throw py::key_error{"the table has no column '" + name + "'"};
          },
          py::arg("name"));
}

}  // namespace kith::python
