#include "livens/io/detail/netcdf_file.h"

#include <cassert>
#include <cstdlib>
#include <memory>

#include <netcdf.h>
#include <netcdf_mem.h>

#include "livens/io/results.h"

namespace livens {

namespace {

/// A file may be recompressed by other tools, so its variables may be larger than it is; not without bound.
constexpr std::size_t largest_expansion = 64;

void check_call(int status, const std::string& what)
{
    if (status == NC_NOERR) return;
    if (status == NC_ENOMEM) throw std::bad_alloc();
    throw IoError(what + ": " + nc_strerror(status));
}

void put_text(int file, int variable, const std::string& name, const std::string& text)
{
    check_call(nc_put_att_text(file, variable, name.c_str(), text.size(), text.data()),
               "cannot form attribute " + name);
}

/// Bytes that the file needs. The image ends with padding of up to 64 KiB; the superblock (version 0, the one
/// that NetCDF asks for) holds the true end of the file as 8 bytes, lowest first, at offset 40 [HDF5 File
/// Format 3.0, II.A].
std::size_t true_size(std::string_view image)
{
    if (image.size() < 48 || image[8] != 0) return image.size();
    std::uint64_t end = 0;
    for (std::size_t i = 0; i < 8; ++i)
        end |= static_cast<std::uint64_t>(static_cast<unsigned char>(image[40 + i])) << (8 * i);
    return end >= 48 && end <= image.size() ? static_cast<std::size_t>(end) : image.size();
}

struct Free {
    void operator()(void* memory) const { std::free(memory); }
};

}   // namespace

NetcdfWriter::NetcdfWriter(std::size_t size_hint)
{
    check_call(nc_create_mem("run", NC_NETCDF4 | NC_CLOBBER, size_hint, &file_),
               "cannot form a NetCDF-4 file");
    int old_mode = 0;
    check_call(nc_set_fill(file_, NC_NOFILL, &old_mode), "cannot form a NetCDF-4 file");
}

NetcdfWriter::~NetcdfWriter()
{
    if (file_ >= 0) nc_abort(file_);
}

void NetcdfWriter::dimension(const std::string& name, std::size_t length)
{
    if (length == 0) return;
    int id = -1;
    check_call(nc_def_dim(file_, name.c_str(), length, &id), "cannot form dimension " + name);
    dimensions_[name] = {id, length};
}

void NetcdfWriter::attribute(const std::string& name, const std::string& text)
{
    assert(text.size() <= max_attribute);
    put_text(file_, NC_GLOBAL, name, text);
}

void NetcdfWriter::attribute(const std::string& name, int number)
{
    check_call(nc_put_att_int(file_, NC_GLOBAL, name.c_str(), NC_INT, 1, &number),
               "cannot form attribute " + name);
}

void NetcdfWriter::attribute(const std::string& name, long long number)
{
    check_call(nc_put_att_longlong(file_, NC_GLOBAL, name.c_str(), NC_INT64, 1, &number),
               "cannot form attribute " + name);
}

void NetcdfWriter::attribute(const std::string& name, double number)
{
    check_call(nc_put_att_double(file_, NC_GLOBAL, name.c_str(), NC_DOUBLE, 1, &number),
               "cannot form attribute " + name);
}

void NetcdfWriter::define(const VariableInfo& info, int type, const void* data, std::size_t n_values)
{
    std::vector<int> ids;
    std::size_t product = 1;
    for (const std::string& name : info.dimensions) {
        const auto& [id, length] = dimensions_.at(name);
        ids.push_back(id);
        product *= length;
    }
    assert(product == n_values);
    (void)product;
    (void)n_values;
    int variable = -1;
    const std::string what = "cannot form variable " + info.name;
    check_call(
        nc_def_var(file_, info.name.c_str(), type, static_cast<int>(ids.size()), ids.data(), &variable),
        what);
    if (type == NC_CHAR) put_text(file_, variable, "_Encoding", "utf-8");
    put_text(file_, variable, "units", info.units);
    put_text(file_, variable, "long_name", info.long_name);
    put_text(file_, variable, "frame", info.frame);
    for (const auto& [name, text] : info.text_attributes) put_text(file_, variable, name, text);
    for (const auto& [name, number] : info.int_attributes)
        check_call(nc_put_att_int(file_, variable, name.c_str(), NC_INT, 1, &number), what);
    pending_.push_back({variable, data});
}

void NetcdfWriter::variable(const VariableInfo& info, std::span<const double> values)
{
    define(info, NC_DOUBLE, values.data(), values.size());
}

void NetcdfWriter::variable(const VariableInfo& info, std::span<const int> values)
{
    define(info, NC_INT, values.data(), values.size());
}

void NetcdfWriter::variable(const VariableInfo& info, std::span<const signed char> values)
{
    define(info, NC_BYTE, values.data(), values.size());
}

void NetcdfWriter::text_variable(const VariableInfo& info, std::string bytes)
{
    texts_.push_back(std::move(bytes));
    define(info, NC_CHAR, texts_.back().data(), texts_.back().size());
}

std::string NetcdfWriter::image()
{
    check_call(nc_enddef(file_), "cannot form a NetCDF-4 file");
    for (const Pending& p : pending_)
        check_call(nc_put_var(file_, p.variable, p.data), "cannot form a NetCDF-4 file");
    NC_memio memory{};
    const int status = nc_close_memio(file_, &memory);
    file_ = -1;
    check_call(status, "cannot form a NetCDF-4 file");
    const std::unique_ptr<void, Free> owner(memory.memory);
    const std::string_view whole(static_cast<const char*>(memory.memory), memory.size);
    return std::string(whole.substr(0, true_size(whole)));
}

NetcdfReader::NetcdfReader(std::string& image) : image_size_(image.size())
{
    static constexpr std::string_view signature = "\x89HDF\r\n\x1a\n";
    if (std::string_view(image).substr(0, signature.size()) != signature)
        throw IoError(image.empty() ? "the file is empty" : "this is no NetCDF-4 file");
    const int status = nc_open_mem("run", NC_NOWRITE, image.size(), image.data(), &file_);
    if (status != NC_NOERR)
        throw IoError(std::string("this is no whole NetCDF-4 file, it may have been cut off (") +
                      nc_strerror(status) + ")");
}

NetcdfReader::~NetcdfReader() { nc_close(file_); }

std::size_t NetcdfReader::dimension(const std::string& name) const
{
    int id = -1;
    std::size_t length = 0;
    if (nc_inq_dimid(file_, name.c_str(), &id) != NC_NOERR) return 0;
    check_call(nc_inq_dimlen(file_, id, &length), "cannot read dimension " + name);
    return length;
}

bool NetcdfReader::has_attribute(const std::string& name) const
{
    int id = -1;
    return nc_inq_attid(file_, NC_GLOBAL, name.c_str(), &id) == NC_NOERR;
}

std::string NetcdfReader::text_attribute(const std::string& name) const
{
    return text_attribute(NC_GLOBAL, name);
}

std::string NetcdfReader::text_attribute_of(const std::string& variable, const std::string& name) const
{
    return text_attribute(find(variable), name);
}

std::vector<std::string> NetcdfReader::attributes() const
{
    int n = 0;
    check_call(nc_inq_natts(file_, &n), "cannot read attributes");
    std::vector<std::string> names;
    for (int i = 0; i < n; ++i) {
        char name[NC_MAX_NAME + 1] = {};
        check_call(nc_inq_attname(file_, NC_GLOBAL, i, name), "cannot read attributes");
        names.emplace_back(name);
    }
    return names;
}

std::vector<std::string> NetcdfReader::variables() const
{
    int n = 0;
    check_call(nc_inq_nvars(file_, &n), "cannot read variables");
    std::vector<std::string> names;
    for (int i = 0; i < n; ++i) {
        char name[NC_MAX_NAME + 1] = {};
        check_call(nc_inq_varname(file_, i, name), "cannot read variables");
        names.emplace_back(name);
    }
    return names;
}

int NetcdfReader::find(const std::string& variable) const
{
    int id = -1;
    check_call(nc_inq_varid(file_, variable.c_str(), &id), "cannot read variable " + variable);
    return id;
}

std::string NetcdfReader::text_attribute(int variable, const std::string& name) const
{
    nc_type type = 0;
    std::size_t length = 0;
    const std::string what = "cannot read attribute " + name;
    check_call(nc_inq_att(file_, variable, name.c_str(), &type, &length), what);
    if (type != NC_CHAR || length > image_size_) throw IoError(what + ": it is not what livens writes");
    std::string text(length, '\0');
    if (length > 0) check_call(nc_get_att_text(file_, variable, name.c_str(), text.data()), what);
    return text;
}

namespace {

/// Attributes are read into one number, so there must be one and it must be a number.
void check_single_number(int file, int variable, const std::string& name)
{
    nc_type type = 0;
    std::size_t length = 0;
    check_call(nc_inq_att(file, variable, name.c_str(), &type, &length), "cannot read attribute " + name);
    if (length != 1 || type == NC_CHAR || type > NC_UINT64 || type == NC_STRING)
        throw IoError("cannot read attribute " + name + ": it is no single number");
}

}   // namespace

long long NetcdfReader::int_attribute(const std::string& name) const
{
    check_single_number(file_, NC_GLOBAL, name);
    long long number = 0;
    check_call(nc_get_att_longlong(file_, NC_GLOBAL, name.c_str(), &number), "cannot read attribute " + name);
    return number;
}

double NetcdfReader::double_attribute(const std::string& name) const
{
    check_single_number(file_, NC_GLOBAL, name);
    double number = 0;
    check_call(nc_get_att_double(file_, NC_GLOBAL, name.c_str(), &number), "cannot read attribute " + name);
    return number;
}

int NetcdfReader::int_attribute_of(const std::string& variable, const std::string& name) const
{
    const int id = find(variable);
    int number = 0;
    check_single_number(file_, id, name);
    check_call(nc_get_att_int(file_, id, name.c_str(), &number), "cannot read attribute " + name);
    return number;
}

bool NetcdfReader::has_variable(const std::string& name) const
{
    int id = -1;
    return nc_inq_varid(file_, name.c_str(), &id) == NC_NOERR;
}

std::size_t NetcdfReader::check(const VariableInfo& info, int type, std::size_t value_size,
                                int& variable) const
{
    const std::string what = "cannot read variable " + info.name;
    variable = find(info.name);
    int n_dimensions = 0;
    nc_type found = 0;
    check_call(nc_inq_vartype(file_, variable, &found), what);
    check_call(nc_inq_varndims(file_, variable, &n_dimensions), what);
    if (found != type || n_dimensions != static_cast<int>(info.dimensions.size()))
        throw IoError(what + ": it has not the type or shape that livens writes");
    std::vector<int> ids(static_cast<std::size_t>(n_dimensions));
    check_call(nc_inq_vardimid(file_, variable, ids.data()), what);
    const std::size_t limit = largest_expansion * image_size_ / value_size;
    std::size_t product = 1;
    for (std::size_t d = 0; d < ids.size(); ++d) {
        int expected = -1;
        std::size_t length = 0;
        if (nc_inq_dimid(file_, info.dimensions[d].c_str(), &expected) != NC_NOERR || expected != ids[d])
            throw IoError(what + ": it does not extend over " + info.dimensions[d]);
        check_call(nc_inq_dimlen(file_, ids[d], &length), what);
        if (length == 0 || length > limit / product)
            throw IoError(what + ": its size does not fit the size of the file");
        product *= length;
    }
    return product;
}

std::vector<double> NetcdfReader::doubles(const VariableInfo& info) const
{
    int variable = -1;
    std::vector<double> values(check(info, NC_DOUBLE, sizeof(double), variable));
    check_call(nc_get_var_double(file_, variable, values.data()), "cannot read variable " + info.name);
    return values;
}

std::vector<int> NetcdfReader::ints(const VariableInfo& info) const
{
    int variable = -1;
    std::vector<int> values(check(info, NC_INT, sizeof(int), variable));
    check_call(nc_get_var_int(file_, variable, values.data()), "cannot read variable " + info.name);
    return values;
}

std::vector<signed char> NetcdfReader::bytes(const VariableInfo& info) const
{
    int variable = -1;
    std::vector<signed char> values(check(info, NC_BYTE, 1, variable));
    check_call(nc_get_var_schar(file_, variable, values.data()), "cannot read variable " + info.name);
    return values;
}

std::string NetcdfReader::text(const VariableInfo& info) const
{
    int variable = -1;
    std::string bytes(check(info, NC_CHAR, 1, variable), '\0');
    check_call(nc_get_var_text(file_, variable, bytes.data()), "cannot read variable " + info.name);
    return bytes;
}

}   // namespace livens
