#include "arrays.hpp"

#include <cmath>
#include <cstring>

namespace kith::python {
namespace {

constexpr std::size_t kMaxNumbers = 200'000'000;
constexpr std::size_t kMaxDepth = 8;

[[noreturn]] void refuse(const std::string& what, const std::string& why) { throw py::value_error{what + " " + why}; }

double checked(double number, const std::string& what) {
  if (!std::isfinite(number)) refuse(what, "must be finite numbers, without NaN");
  return number;
}

template <typename Number>
double number_at(const char* place) {
  Number number;
  std::memcpy(&number, place, sizeof number);
  return static_cast<double>(number);
}

using Read = double (*)(const char*);

// How numbers of a buffer's format are read; null for what are no numbers of this machine.
Read reader_of(const char* format) {
  std::string text = format == nullptr ? "B" : format;
  if (!text.empty() && (text[0] == '@' || text[0] == '=' || text[0] == '<' || text[0] == '|')) text.erase(0, 1);
  if (text.size() != 1) return nullptr;
  switch (text[0]) {
    case 'd':
      return number_at<double>;
    case 'f':
      return number_at<float>;
    case 'g':
      return number_at<long double>;
    case '?':
      return number_at<std::uint8_t>;
    case 'b':
      return number_at<std::int8_t>;
    case 'B':
      return number_at<std::uint8_t>;
    case 'h':
      return number_at<std::int16_t>;
    case 'H':
      return number_at<std::uint16_t>;
    case 'i':
      return number_at<std::int32_t>;
    case 'I':
      return number_at<std::uint32_t>;
    case 'l':
    case 'q':
    case 'n':
      return number_at<std::int64_t>;
    case 'L':
    case 'Q':
    case 'N':
      return number_at<std::uint64_t>;
    default:
      return nullptr;
  }
}

class Buffer {
 public:
  Buffer(const py::handle& object, const std::string& what) {
    if (PyObject_GetBuffer(object.ptr(), &view_, PyBUF_STRIDED_RO | PyBUF_FORMAT) != 0) {
      PyErr_Clear();
      throw py::type_error{what + " cannot be read as an array"};
    }
  }
  ~Buffer() { PyBuffer_Release(&view_); }
  Buffer(const Buffer&) = delete;
  Buffer& operator=(const Buffer&) = delete;

  [[nodiscard]] Numbers numbers(const std::string& what) const {
    const auto read = reader_of(view_.format);
    if (read == nullptr) throw py::type_error{what + " must be an array of numbers in this machine's byte order"};
    Numbers result;
    std::size_t count = 1;
    for (int k = 0; k < view_.ndim; ++k) {
      result.shape.push_back(static_cast<std::size_t>(view_.shape[k]));
      count *= result.shape.back();
      if (count > kMaxNumbers) refuse(what, "has too many numbers");
    }
    result.values.reserve(count);
    if (count > 0) take(read, static_cast<const char*>(view_.buf), 0, what, result.values);
    return result;
  }

 private:
  void take(Read read, const char* place, int k, const std::string& what, std::vector<double>& values) const {
    if (k == view_.ndim) {
      values.push_back(checked(read(place), what));
      return;
    }
    for (py::ssize_t i = 0; i < view_.shape[k]; ++i) take(read, place + i * view_.strides[k], k + 1, what, values);
  }

  Py_buffer view_{};
};

bool is_text(const py::handle& object) { return PyUnicode_Check(object.ptr()) || PyBytes_Check(object.ptr()); }

double number_of(const py::handle& object, const std::string& what) {
  const double number = PyFloat_AsDouble(object.ptr());
  if (number == -1.0 && PyErr_Occurred() != nullptr) {
    PyErr_Clear();
    throw py::type_error{what + " must be numbers, not " + py::str(py::type::handle_of(object)).cast<std::string>()};
  }
  return checked(number, what);
}

void take_sequence(const py::handle& object, std::size_t depth, const std::string& what, Numbers& numbers) {
  if (depth > kMaxDepth) refuse(what, "is nested too deep");
  const auto sequence = py::reinterpret_steal<py::object>(PySequence_Tuple(object.ptr()));
  if (!sequence) throw py::error_already_set{};
  const py::tuple items{sequence};
  if (numbers.shape.size() == depth) numbers.shape.push_back(items.size());
  if (numbers.shape[depth] != items.size()) refuse(what, "must have rows of equal length");
  for (const auto& item : items) {
    if (!is_text(item) && PySequence_Check(item.ptr()) != 0) {
      take_sequence(item, depth + 1, what, numbers);
    } else if (numbers.shape.size() == depth + 1) {
      if (numbers.values.size() >= kMaxNumbers) refuse(what, "has too many numbers");
      numbers.values.push_back(number_of(item, what));
    } else {
      refuse(what, "must have rows of equal length");
    }
  }
}

}  // namespace

Numbers numbers_of(const py::handle& object, const std::string& what) {
  if (is_text(object) || object.is_none()) throw py::type_error{what + " must be numbers"};
  if (PyObject_CheckBuffer(object.ptr()) != 0) return Buffer{object, what}.numbers(what);
  Numbers numbers;
  if (PySequence_Check(object.ptr()) == 0) {
    numbers.values.push_back(number_of(object, what));
    return numbers;
  }
  take_sequence(object, 0, what, numbers);
  std::size_t count = 1;
  for (const auto n : numbers.shape) count *= n;
  if (count != numbers.values.size()) refuse(what, "must have rows of equal length");
  return numbers;
}

IntegerVector integers_of(const py::handle& object, std::size_t dimension, const std::string& what) {
  const auto numbers = numbers_of(object, what);
  if (numbers.shape.size() != 1 || numbers.values.size() > IntegerVector::kMaxDimension ||
      (dimension > 0 && numbers.values.size() != dimension)) {
    refuse(what, "must be " + (dimension > 0 ? std::to_string(dimension) : std::string{"2 to 8"}) + " whole numbers");
  }
  IntegerVector vector(numbers.values.size());
  for (std::size_t k = 0; k < vector.size(); ++k) {
    const double number = numbers.values[k];
    constexpr double kLimit = 2147483648.0;
    if (number != std::floor(number) || std::abs(number) >= kLimit) refuse(what, "must be whole numbers below 2^31");
    vector[k] = static_cast<std::int64_t>(number);
  }
  return vector;
}

Direction direction_of(const py::handle& object, std::size_t dimension, const std::string& what) {
  const auto numbers = numbers_of(object, what);
  if (numbers.shape.size() != 1 || numbers.values.size() != dimension)
    refuse(what, "must be " + std::to_string(dimension) + " numbers");
  Direction direction(static_cast<Eigen::Index>(dimension));
  double largest = 0.0;
  for (const double number : numbers.values) largest = std::max(largest, std::abs(number));
  if (largest < 1e-150 || largest > 1e150) refuse(what, "must not all be 0, nor beyond 1e150 in size");
  for (std::size_t k = 0; k < dimension; ++k) direction[static_cast<Eigen::Index>(k)] = numbers.values[k] / largest;
  return direction.normalized();
}

std::vector<HalfSpace> half_spaces_of(const py::handle& object, std::size_t dimension) {
  const std::string what = "half-spaces";
  const auto numbers = numbers_of(object, what);
  std::vector<HalfSpace> half_spaces;
  if (numbers.values.empty() && numbers.shape.size() <= 2) return half_spaces;
  if (numbers.shape.size() > 2 || numbers.shape.empty()) refuse(what, "must be a normal or a list of normals");
  const auto d = numbers.shape.back();
  if (d < 2 || d > IntegerVector::kMaxDimension || (dimension > 0 && d != dimension)) {
    refuse(what, "must have " + (dimension > 0 ? std::to_string(dimension) : std::string{"2 to 8"}) + " entries");
  }
  for (std::size_t i = 0; i < numbers.values.size(); i += d) {
    IntegerVector normal(d);
    for (std::size_t k = 0; k < d; ++k) {
      const double number = numbers.values[i + k];
      if (number != std::floor(number) || std::abs(number) >= 2147483648.0)
        refuse(what, "must have whole numbers below 2^31 as normals, such as (0, 1, -2)");
      normal[k] = static_cast<std::int64_t>(number);
    }
    half_spaces.emplace_back(normal);
  }
  return half_spaces;
}

py::tuple to_tuple(const IntegerVector& v) {
  py::tuple tuple{v.size()};
  for (std::size_t k = 0; k < v.size(); ++k) tuple[k] = py::int_(v[k]);
  return tuple;
}

py::tuple to_tuple(const Direction& v) {
  py::tuple tuple{static_cast<std::size_t>(v.size())};
  for (Eigen::Index k = 0; k < v.size(); ++k) tuple[static_cast<std::size_t>(k)] = py::float_(v[k]);
  return tuple;
}

py::list to_list(std::span<const HalfSpace> half_spaces) {
  py::list list;
  for (const auto& half_space : half_spaces) list.append(to_tuple(half_space.normal()));
  return list;
}

py::tuple counts_to_tuple(const Domain& domain, const IntegerVector& counts) {
  if (domain.count_scale() == 1) return to_tuple(counts);
  py::tuple tuple{counts.size()};
  for (std::size_t k = 0; k < counts.size(); ++k)
    tuple[k] = py::float_(static_cast<double>(counts[k]) / static_cast<double>(domain.count_scale()));
  return tuple;
}

IntegerVector counts_of(const Domain& domain, const py::handle& object) {
  const std::string what = "feature counts";
  if (domain.count_scale() == 1) return integers_of(object, domain.num_features(), what);
  const auto numbers = numbers_of(object, what);
  if (numbers.shape.size() != 1 || numbers.values.size() != domain.num_features())
    refuse(what, "must be " + std::to_string(domain.num_features()) + " numbers");
  IntegerVector counts(numbers.values.size());
  for (std::size_t k = 0; k < counts.size(); ++k) {
    const double scaled = std::round(numbers.values[k] * static_cast<double>(domain.count_scale()));
    constexpr double kLimit = 4503599627370496.0;  // 2^52
    if (std::abs(scaled) >= kLimit) refuse(what, "are too large");
    counts[k] = static_cast<std::int64_t>(scaled);
  }
  return counts;
}

std::size_t item_size(char format) noexcept { return format == '?' ? 1 : 8; }

py::object as_array(Array array) {
  const auto object = py::cast(std::move(array));
  try {
    return py::module_::import("numpy").attr("asarray")(object);
  } catch (py::error_already_set& error) {
    if (!error.matches(PyExc_ImportError)) throw;
  }
  return py::memoryview{object};
}

py::object as_array(std::vector<double> values, std::vector<py::ssize_t> shape) {
  const auto owner = std::make_shared<const std::vector<double>>(std::move(values));
  std::vector<py::ssize_t> strides(shape.size(), sizeof(double));
  for (std::size_t k = shape.size(); k-- > 1;) strides[k - 1] = strides[k] * shape[k];
  return as_array(Array{owner, owner->data(), 'd', std::move(shape), std::move(strides)});
}

void bind_arrays(py::module_& module) {
  py::class_<Array>(module, "Array", py::buffer_protocol(), "Memory of kith, for numpy.asarray() and memoryview().")
      .def_buffer([](Array& array) {
        static double nothing = 0.0;  // an empty vector may have no memory
        auto* data = array.data == nullptr ? static_cast<void*>(&nothing) : const_cast<void*>(array.data);
        return py::buffer_info{data,
                               static_cast<py::ssize_t>(item_size(array.format)),
                               std::string{array.format},
                               static_cast<py::ssize_t>(array.shape.size()),
                               array.shape,
                               array.strides,
                               true};
      });
}

}  // namespace kith::python
