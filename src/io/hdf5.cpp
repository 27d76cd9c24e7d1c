#include "io/hdf5.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <functional>
#include <numeric>
#include <utility>

#include "core/error.hpp"

namespace bagnold::io {
namespace {

// Closes an identifier of the C library when it goes out of scope.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle& operator=(Handle&&) = delete;
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

template <class T>
hid_t native_type() {
  if constexpr (std::is_same_v<T, double>) return H5T_NATIVE_DOUBLE;
  if constexpr (std::is_same_v<T, float>) return H5T_NATIVE_FLOAT;
  if constexpr (std::is_same_v<T, std::int32_t>) return H5T_NATIVE_INT32;
  if constexpr (std::is_same_v<T, std::int64_t>) return H5T_NATIVE_INT64;
  if constexpr (std::is_same_v<T, std::uint8_t>) return H5T_NATIVE_UINT8;
}

// What the library says went wrong, innermost cause.
std::string library_reason() {
  std::string reason;
  H5Ewalk2(
      H5E_DEFAULT, H5E_WALK_UPWARD,
      [](unsigned n, const H5E_error2_t* error, void* text) -> herr_t {
        if (n == 0 && error->desc != nullptr) *static_cast<std::string*>(text) = error->desc;
        return 0;
      },
      &reason);
  return reason;
}

std::size_t count(const Dims& dims) {
  return std::accumulate(dims.begin(), dims.end(), std::size_t{1}, std::multiplies<>());
}

// Chunks of about a MiB, cut along the first dimension: few enough to be quick, small enough to compress in
// cache.
std::vector<hsize_t> chunk_of(const std::vector<hsize_t>& dims, std::size_t element) {
  constexpr std::size_t target_bytes = 1u << 20;
  std::size_t row = element;
  for (std::size_t k = 1; k < dims.size(); ++k) row *= dims[k];
  auto chunk = dims;
  chunk[0] = std::clamp<hsize_t>(target_bytes / row, 1, dims[0]);
  return chunk;
}

}  // namespace

struct H5File::Impl {
  hid_t id = -1;
  std::filesystem::path path;

  [[noreturn]] void fail(const std::string& object, const std::string& what) const {
    const auto reason = library_reason();
    H5Eclear2(H5E_DEFAULT);
    throw IoError(fmt::format("{}: error: {}{}{}", path.string(), object.empty() ? "" : "'" + object + "': ", what,
                              reason.empty() ? "" : " (" + reason + ")"));
  }

  bool exists(const std::string& object) const {
    if (object.empty() || object == "/") return true;
    for (std::size_t end = object.find('/', 1);; end = object.find('/', end + 1)) {  // every group on the way
      const auto part = object.substr(0, end);
      if (part.back() != '/' && H5Lexists(id, part.c_str(), H5P_DEFAULT) <= 0) return false;
      if (end == std::string::npos) return true;
    }
  }

  Handle open_dataset(const std::string& dataset) const {
    if (!exists(dataset)) fail(dataset, "no such dataset");
    Handle data(H5Dopen2(id, dataset.c_str(), H5P_DEFAULT), H5Dclose);
    if (data < 0) fail(dataset, "cannot open the dataset");
    return data;
  }

  Handle open_object(const std::string& object) const {
    if (!exists(object)) fail(object, "no such group or dataset");
    Handle handle(H5Oopen(id, object.empty() ? "/" : object.c_str(), H5P_DEFAULT), H5Oclose);
    if (handle < 0) fail(object, "cannot open");
    return handle;
  }

  Dims dims(hid_t data, const std::string& dataset) const {
    const Handle space(H5Dget_space(data), H5Sclose);
    const int rank = H5Sget_simple_extent_ndims(space);
    if (rank < 0) fail(dataset, "cannot read the shape");
    std::vector<hsize_t> extent(static_cast<std::size_t>(rank));
    H5Sget_simple_extent_dims(space, extent.data(), nullptr);
    return {extent.begin(), extent.end()};
  }

  void write(const std::string& dataset, hid_t type, const void* data, const Dims& shape, Compress compress) {
    std::vector<hsize_t> extent(shape.begin(), shape.end());
    if (exists(dataset) && H5Ldelete(id, dataset.c_str(), H5P_DEFAULT) < 0) fail(dataset, "cannot replace");
    const Handle space(H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr), H5Sclose);
    const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
    H5Pset_create_intermediate_group(links, 1);
    const Handle layout(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_obj_track_times(layout, false);  // same run, same file
    if (compress == Compress::yes && count(shape) > 0) {
      const auto chunk = chunk_of(extent, H5Tget_size(type));
      H5Pset_chunk(layout, static_cast<int>(chunk.size()), chunk.data());
      H5Pset_shuffle(layout);
      H5Pset_deflate(layout, 4);
    }
    const Handle set(H5Dcreate2(id, dataset.c_str(), type, space, links, layout, H5P_DEFAULT), H5Dclose);
    if (set < 0) fail(dataset, "cannot create the dataset");
    if (H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0) fail(dataset, "cannot write");
  }

  void write_attribute(const std::string& object, const std::string& name, hid_t type, const void* value) {
    if (!exists(object)) create_group(object);
    const auto target = open_object(object);
    if (H5Aexists(target, name.c_str()) > 0) H5Adelete(target, name.c_str());
    const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    const Handle attribute(H5Acreate2(target, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    if (attribute < 0 || H5Awrite(attribute, type, value) < 0) fail(object, "cannot write the attribute " + name);
  }

  Handle open_attribute(const std::string& object, const std::string& name, H5T_class_t kind) const {
    const auto target = open_object(object);
    if (H5Aexists(target, name.c_str()) <= 0) fail(object, "no attribute " + name);
    Handle attribute(H5Aopen(target, name.c_str(), H5P_DEFAULT), H5Aclose);
    if (attribute < 0) fail(object, "cannot open the attribute " + name);
    const Handle type(H5Aget_type(attribute), H5Tclose);
    const auto stored = H5Tget_class(type);
    if (stored != kind && !(kind == H5T_FLOAT && stored == H5T_INTEGER))
      fail(object, "the attribute " + name + " has another type");
    return attribute;
  }

  void create_group(const std::string& group) {
    if (exists(group)) return;
    const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
    H5Pset_create_intermediate_group(links, 1);
    const Handle made(H5Gcreate2(id, group.c_str(), links, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
    if (made < 0) fail(group, "cannot create the group");
  }
};

H5File::H5File(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {
  H5Eset_auto2(H5E_DEFAULT, nullptr,
               nullptr);  // errors are reported by exceptions, not printed by the library
}
H5File::H5File(H5File&&) noexcept = default;
H5File& H5File::operator=(H5File&& other) noexcept {
  std::swap(impl_, other.impl_);
  return *this;
}
H5File::~H5File() {
  if (impl_ && impl_->id >= 0) H5Fclose(impl_->id);
}

H5File H5File::create(const std::filesystem::path& path) {
  H5File file(std::make_unique<Impl>());
  file.impl_->path = path;
  file.impl_->id = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  if (file.impl_->id < 0) file.impl_->fail("", "cannot create");
  return file;
}

H5File H5File::read_only(const std::filesystem::path& path) {
  H5File file(std::make_unique<Impl>());
  file.impl_->path = path;
  if (!std::filesystem::exists(path)) file.impl_->fail("", "no such file");
  file.impl_->id = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file.impl_->id < 0) file.impl_->fail("", "not a readable HDF5 file");
  return file;
}

H5File H5File::append(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path)) return create(path);
  H5File file(std::make_unique<Impl>());
  file.impl_->path = path;
  file.impl_->id = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  if (file.impl_->id < 0) file.impl_->fail("", "cannot open for writing");
  return file;
}

const std::filesystem::path& H5File::path() const { return impl_->path; }

void H5File::flush() {
  if (H5Fflush(impl_->id, H5F_SCOPE_LOCAL) < 0) impl_->fail("", "cannot write");
}

void H5File::close() {
  if (impl_->id >= 0 && H5Fclose(std::exchange(impl_->id, -1)) < 0) impl_->fail("", "cannot write");
}

template <class T>
void H5File::write(const std::string& dataset, std::span<const T> data, Dims dims, Compress compress) {
  if constexpr (std::is_same_v<T, Vec3>) {
    static_assert(sizeof(Vec3) == 3 * sizeof(double));
    if (dims.empty()) dims = {data.size()};
    dims.push_back(3);
    write(dataset, std::span(reinterpret_cast<const double*>(data.data()), 3 * data.size()), dims, compress);
  } else {
    if (dims.empty()) dims = {data.size()};
    if (count(dims) != data.size())
      impl_->fail(dataset, fmt::format("{} values do not fill the given shape of {}", data.size(), count(dims)));
    impl_->write(dataset, native_type<T>(), data.data(), dims, compress);
  }
}

template <class T>
std::vector<T> H5File::read(const std::string& dataset) const {
  const auto set = impl_->open_dataset(dataset);
  const auto shape = impl_->dims(set, dataset);
  const Handle stored(H5Dget_type(set), H5Tclose);
  using Number = std::conditional_t<std::is_same_v<T, Vec3>, double, T>;
  const bool stored_integer = H5Tget_class(stored) == H5T_INTEGER, stored_float = H5Tget_class(stored) == H5T_FLOAT;
  const bool fits = std::is_integral_v<Number> ? stored_integer && H5Tget_size(stored) <= sizeof(Number)
                    : stored_float             ? H5Tget_size(stored) <= sizeof(Number)
                                               : stored_integer && H5Tget_size(stored) < sizeof(Number);
  if (!fits) impl_->fail(dataset, "the numbers stored do not fit the type asked for");
  if (std::is_same_v<T, Vec3> && (shape.empty() || shape.back() != 3)) impl_->fail(dataset, "expected n x 3 numbers");
  std::vector<T> data(std::is_same_v<T, Vec3> ? count(shape) / 3 : count(shape));
  if (H5Dread(set, native_type<Number>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, data.data()) < 0)
    impl_->fail(dataset, "cannot read");
  return data;
}

template void H5File::write(const std::string&, std::span<const double>, Dims, Compress);
template void H5File::write(const std::string&, std::span<const float>, Dims, Compress);
template void H5File::write(const std::string&, std::span<const std::int32_t>, Dims, Compress);
template void H5File::write(const std::string&, std::span<const std::int64_t>, Dims, Compress);
template void H5File::write(const std::string&, std::span<const std::uint8_t>, Dims, Compress);
template void H5File::write(const std::string&, std::span<const Vec3>, Dims, Compress);
template std::vector<double> H5File::read(const std::string&) const;
template std::vector<float> H5File::read(const std::string&) const;
template std::vector<std::int32_t> H5File::read(const std::string&) const;
template std::vector<std::int64_t> H5File::read(const std::string&) const;
template std::vector<std::uint8_t> H5File::read(const std::string&) const;
template std::vector<Vec3> H5File::read(const std::string&) const;

Dims H5File::dims(const std::string& dataset) const { return impl_->dims(impl_->open_dataset(dataset), dataset); }

bool H5File::exists(const std::string& object) const { return impl_->exists(object); }

std::vector<std::string> H5File::children(const std::string& group) const {
  const auto target = impl_->open_object(group);
  std::vector<std::string> names;
  const auto collect = [](hid_t, const char* name, const H5L_info_t*, void* list) -> herr_t {
    static_cast<std::vector<std::string>*>(list)->emplace_back(name);
    return 0;
  };
  if (H5Literate(target, H5_INDEX_NAME, H5_ITER_INC, nullptr, collect, &names) < 0)
    impl_->fail(group, "cannot list the group");
  return names;
}

void H5File::remove(const std::string& object) {
  if (!exists(object)) impl_->fail(object, "no such group or dataset");
  if (H5Ldelete(impl_->id, object.c_str(), H5P_DEFAULT) < 0) impl_->fail(object, "cannot remove");
}

void H5File::create_group(const std::string& group) { impl_->create_group(group); }

void H5File::attribute(const std::string& object, const std::string& name, const std::string& value) {
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, H5T_VARIABLE);  // no limit of 64 KiB on the length
  H5Tset_cset(type, H5T_CSET_UTF8);
  const char* text = value.c_str();
  impl_->write_attribute(object, name, type, static_cast<const void*>(&text));
}
void H5File::attribute(const std::string& object, const std::string& name, const char* value) {
  attribute(object, name, std::string(value));
}
void H5File::attribute(const std::string& object, const std::string& name, double value) {
  impl_->write_attribute(object, name, H5T_NATIVE_DOUBLE, &value);
}
void H5File::int_attribute(const std::string& object, const std::string& name, std::int64_t value) {
  impl_->write_attribute(object, name, H5T_NATIVE_INT64, &value);
}

bool H5File::has_attribute(const std::string& object, const std::string& name) const {
  return exists(object) && H5Aexists(impl_->open_object(object), name.c_str()) > 0;
}

std::string H5File::string_attribute(const std::string& object, const std::string& name) const {
  const auto attribute = impl_->open_attribute(object, name, H5T_STRING);
  const Handle stored(H5Aget_type(attribute), H5Tclose);
  if (H5Tis_variable_str(stored) <= 0) {  // fixed length, as other programs write it
    std::string text(H5Tget_size(stored), '\0');
    if (H5Aread(attribute, stored, text.data()) < 0) impl_->fail(object, "cannot read the attribute " + name);
    return text.substr(0, text.find('\0'));
  }
  char* text = nullptr;
  if (H5Aread(attribute, stored, static_cast<void*>(&text)) < 0)
    impl_->fail(object, "cannot read the attribute " + name);
  const std::string value = text == nullptr ? "" : text;
  H5free_memory(text);
  return value;
}

double H5File::double_attribute(const std::string& object, const std::string& name) const {
  double value = 0;
  if (H5Aread(impl_->open_attribute(object, name, H5T_FLOAT), H5T_NATIVE_DOUBLE, &value) < 0)
    impl_->fail(object, "cannot read the attribute " + name);
  return value;
}

std::int64_t H5File::int_attribute(const std::string& object, const std::string& name) const {
  std::int64_t value = 0;
  if (H5Aread(impl_->open_attribute(object, name, H5T_INTEGER), H5T_NATIVE_INT64, &value) < 0)
    impl_->fail(object, "cannot read the attribute " + name);
  return value;
}

}  // namespace bagnold::io
