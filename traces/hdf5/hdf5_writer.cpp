#include "traces/hdf5/hdf5_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <utility>

namespace vestige {

namespace {

static_assert(std::endian::native == std::endian::little, "HDF5's little-endian types stand for ours");

using Dimensions = std::vector<hsize_t>;

constexpr std::size_t kChunkBytes = std::size_t{1} << 18;

}  // namespace

void write_hdf5_attribute(hid_t object, const std::string& name, const std::string& text,
                          const std::filesystem::path& path) {
  const Hdf5Library& h5 = hdf5();
  const Hdf5Handle type(h5.copy_type(h5.text), h5.close_type, path, "make a type");
  hdf5_check(h5.set_size(type.id(), std::max<std::size_t>(1, text.size())), path, "make a type");
  hdf5_check(h5.set_character_set(type.id(), H5T_CSET_UTF8), path, "make a type");
  const Hdf5Handle space(h5.create_space(H5S_SCALAR), h5.close_space, path, "make a space");
  Hdf5Handle attribute(h5.create_attribute(object, name.c_str(), type.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT),
                       h5.close_attribute, path, "make an attribute");
  hdf5_check(h5.write_attribute(attribute.id(), type.id(), text.c_str()), path, "write an attribute");
}

Hdf5Output::Hdf5Output(const std::filesystem::path& path, Overwrite overwrite)
    : file_(path, overwrite), path_(path), scratch_(path, ScratchName::kKept) {
  const Hdf5Library& h5 = hdf5();
  // From HDF5 1.10 on, the metadata of the tables have checksums, too.
  const Hdf5Handle how(h5.create_properties(h5.file_access), h5.close_properties, path, "make properties");
  hdf5_check(h5.set_versions(how.id(), H5F_LIBVER_LATEST, H5F_LIBVER_LATEST), path, "choose a version");
  h5_file_ = Hdf5Handle(h5.create_file(scratch_.path().c_str(), kHdf5Truncate, H5P_DEFAULT, how.id()), h5.close_file,
                        path, "make a file");
}

void Hdf5Output::commit() {
  hdf5_check(h5_file_.reset(), path_, "finish the file");
  scratch_.copy_to(file_);
  file_.commit();
}

Hdf5Column::Hdf5Column(hid_t file, const std::filesystem::path& path, Description description)
    : path_(path), description_(std::move(description)) {
  const Hdf5Library& h5 = hdf5();
  row_bytes_ = description_.element_bytes;
  for (const hsize_t size : description_.row) row_bytes_ *= static_cast<std::size_t>(size);
  chunk_rows_ = row_bytes_ == 0 ? 1 : std::clamp<std::size_t>(kChunkBytes / row_bytes_, 1, 4096);
  // A table without columns has no chunks and cannot grow; its shape says that there are no columns.
  const Dimensions most = dimensions(row_bytes_ == 0 ? 0 : H5S_UNLIMITED);
  const Hdf5Handle space(h5.create_simple_space(static_cast<int>(most.size()), dimensions(0).data(), most.data()),
                         h5.close_space, path, "make a space");
  const Hdf5Handle how(h5.create_properties(h5.dataset_creation), h5.close_properties, path, "make properties");
  if (row_bytes_ > 0) {
    hdf5_check(h5.set_chunk(how.id(), static_cast<int>(most.size()), dimensions(chunk_rows_).data()), path,
               "choose chunks");
    hdf5_check(h5.set_shuffle(how.id()), path, "choose a filter");
    hdf5_check(h5.set_deflate(how.id(), 4), path, "choose compression");
    hdf5_check(h5.set_fletcher32(how.id()), path, "choose checksums");
  }
  dataset_ = Hdf5Handle(h5.create_dataset(file, description_.name.c_str(), description_.type, space.id(), H5P_DEFAULT,
                                          how.id(), H5P_DEFAULT),
                        h5.close_dataset, path, fmt::format("make {}", description_.name));
  if (!description_.units.empty()) write_hdf5_attribute(dataset_.id(), "units", description_.units, path);
  if (!description_.axes.empty()) write_hdf5_attribute(dataset_.id(), "axes", description_.axes, path);
  if (!description_.description.empty())
    write_hdf5_attribute(dataset_.id(), "description", description_.description, path);
}

void Hdf5Column::append(const void* row) {
  const auto* bytes = static_cast<const std::byte*>(row);
  waiting_.insert(waiting_.end(), bytes, bytes + row_bytes_);
  ++waiting_rows_;
  if (waiting_rows_ == chunk_rows_) flush();
}

void Hdf5Column::flush() {
  if (waiting_rows_ == 0 || row_bytes_ == 0) return;
  const Hdf5Library& h5 = hdf5();
  const std::string doing = fmt::format("write {}", description_.name);
  hdf5_check(h5.set_extent(dataset_.id(), dimensions(rows_ + waiting_rows_).data()), path_, doing);
  const Hdf5Handle place(h5.space_of(dataset_.id()), h5.close_space, path_, doing);
  Dimensions start(description_.row.size() + 1, 0);
  start[0] = rows_;
  const Dimensions count = dimensions(waiting_rows_);
  hdf5_check(h5.select_hyperslab(place.id(), H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr), path_,
             doing);
  const Hdf5Handle memory(h5.create_simple_space(static_cast<int>(count.size()), count.data(), nullptr), h5.close_space,
                          path_, doing);
  hdf5_check(h5.write(dataset_.id(), description_.type, memory.id(), place.id(), H5P_DEFAULT, waiting_.data()), path_,
             doing);
  rows_ += waiting_rows_;
  waiting_rows_ = 0;
  waiting_.clear();
}

void Hdf5Column::close() {
  flush();
  // Data that HDF5 still buffers go to disk now, which may be full.
  hdf5_check(dataset_.reset(), path_, fmt::format("write {}", description_.name));
}

Dimensions Hdf5Column::dimensions(hsize_t rows) const {
  Dimensions all = {rows};
  all.insert(all.end(), description_.row.begin(), description_.row.end());
  return all;
}

}  // namespace vestige
