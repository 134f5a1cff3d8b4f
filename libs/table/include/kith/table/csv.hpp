#pragma once

// Typed tables as CSV: columns, writing, reading.

#include "kith/table/column.hpp"
#include "kith/table/csv_reader.hpp"
#include "kith/table/csv_writer.hpp"
