#include "traces/hdf5/hdf5_table.hpp"

#include <fmt/format.h>

#include "traces/base/error.hpp"

namespace vestige {

Hdf5Table::Hdf5Table(hid_t file, const std::filesystem::path& path, std::string name, const char* remedy)
    : path_(path), name_(std::move(name)), remedy_(remedy) {
  const Hdf5Library& h5 = hdf5();
  dataset_ = Hdf5Handle(h5.open_dataset(file, name_.c_str(), H5P_DEFAULT), h5.close_dataset);
  if (dataset_.id() < 0 && is_missing(file)) fail("is missing");
  if (dataset_.id() < 0) fail("cannot be opened: the file is damaged", kHdf5DamagedRemedy);
  const Hdf5Handle space(h5.space_of(dataset_.id()), h5.close_space);
  const int rank = h5.rank(space.id());
  if (rank < 1 || rank > 3) fail("does not have 1 to 3 dimensions");
  dimensions_.resize(static_cast<std::size_t>(rank));
  if (h5.dimensions(space.id(), dimensions_.data(), nullptr) < 0) fail("has dimensions that cannot be read");
  const Hdf5Handle type(h5.type_of(dataset_.id()), h5.close_type);
  type_.kind = h5.class_of(type.id());
  if (type_.kind != H5T_INTEGER && type_.kind != H5T_FLOAT) fail("does not hold numbers", kHdf5TypeRemedy);
  type_.bytes = h5.size_of(type.id());
  type_.is_signed = type_.kind == H5T_FLOAT || h5.sign_of(type.id()) == H5T_SGN_2;
}

bool Hdf5Table::is_missing(hid_t file) const {
  for (std::size_t end = name_.find('/');; end = name_.find('/', end + 1)) {
    if (hdf5().link_exists(file, name_.substr(0, end).c_str(), H5P_DEFAULT) == 0) return true;
    if (end == std::string::npos) return false;
  }
}

void Hdf5Table::fail(std::string_view cause, const char* remedy) const {
  throw Error(path_.string(), fmt::format("its table {} {}", name_, cause), remedy);
}

void Hdf5Table::expect(const std::vector<hsize_t>& shape) const {
  bool same = shape.size() == dimensions_.size();
  for (std::size_t i = 0; same && i < shape.size(); ++i) same = shape[i] == dimensions_[i] || (i == 0 && shape[0] == 0);
  if (!same) fail(fmt::format("has the shape ({}), not ({})", fmt::join(dimensions_, ", "), fmt::join(shape, ", ")));
}

bool Hdf5Table::Type::fits_into(const Type& other) const {
  if (kind != other.kind || (is_signed && !other.is_signed)) return false;
  return is_signed == other.is_signed ? bytes <= other.bytes : bytes < other.bytes;
}

std::size_t Hdf5Table::numbers_in(hsize_t rows) const {
  std::size_t numbers = static_cast<std::size_t>(rows);
  for (std::size_t i = 1; i < dimensions_.size(); ++i) numbers *= static_cast<std::size_t>(dimensions_[i]);
  return numbers;
}

void Hdf5Table::read(const Type& type, hsize_t first, hsize_t rows, void* out) const {
  const Hdf5Library& h5 = hdf5();
  // HDF5 would silently change numbers that do not fit.
  if (!type_.fits_into(type))
    fail(fmt::format("may hold numbers that do not fit into {} of {} bits",
                     type.kind == H5T_FLOAT ? "floats"
                     : type.is_signed       ? "whole numbers"
                                            : "unsigned whole numbers",
                     8 * type.bytes),
         kHdf5TypeRemedy);
  const hid_t as = type.kind == H5T_FLOAT ? (type.bytes == 4 ? h5.float32 : h5.float64)
                   : type.is_signed       ? h5.int64
                   : type.bytes == 8      ? h5.uint64
                   : type.bytes == 4      ? h5.uint32
                   : type.bytes == 2      ? h5.uint16
                                          : h5.uint8;
  std::vector<hsize_t> count = dimensions_;
  count[0] = rows;
  std::vector<hsize_t> start(count.size(), 0);
  start[0] = first;
  const Hdf5Handle place(h5.space_of(dataset_.id()), h5.close_space);
  const Hdf5Handle memory(h5.create_simple_space(static_cast<int>(count.size()), count.data(), nullptr),
                          h5.close_space);
  if (h5.select_hyperslab(place.id(), H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr) < 0 ||
      h5.read(dataset_.id(), as, memory.id(), place.id(), H5P_DEFAULT, out) < 0)
    fail(fmt::format("cannot be read from row {} on: the file is damaged, or its compression filter is not installed",
                     first),
         kHdf5DamagedRemedy);
}

}  // namespace vestige
