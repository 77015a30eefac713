// NetCDF-4 files as images in memory: the library never touches the disk, so that a full disk, a dying
// process or an odd file name cannot reach it, and one function (replace_file) answers for what lies on the
// disk.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace livens {

/// What a variable says about itself. `frame` is the frame that its components refer to.
struct VariableInfo {
    std::string name;
    std::vector<std::string> dimensions;
    std::string units = "1";
    std::string frame = "none";
    std::string long_name{};
    std::vector<std::pair<std::string, std::string>> text_attributes{};
    std::vector<std::pair<std::string, int>> int_attributes{};
};

/// Builds a file. Data handed to variable() is read by image(), so it must live until then.
///
/// Nothing in the image depends on time, place or process: same calls, same bytes.
class NetcdfWriter {
public:
    /// `size_hint`: bytes expected, so that memory does not grow in steps.
    explicit NetcdfWriter(std::size_t size_hint);
    ~NetcdfWriter();
    NetcdfWriter(const NetcdfWriter&) = delete;
    NetcdfWriter& operator=(const NetcdfWriter&) = delete;

    /// Length 0 defines nothing (0 means "unlimited" to NetCDF): variables over it must be left out too.
    void dimension(const std::string& name, std::size_t length);
    void attribute(const std::string& name, const std::string& text);   ///< at most 16 KiB, see max_attribute
    void attribute(const std::string& name, int number);
    void attribute(const std::string& name, long long number);
    void attribute(const std::string& name, double number);

    /// The number of values must be the product of the dimensions; asserted.
    void variable(const VariableInfo& info, std::span<const double> values);
    void variable(const VariableInfo& info, std::span<const int> values);
    void variable(const VariableInfo& info, std::span<const signed char> values);
    /// Text: NC_CHAR with `_Encoding = "utf-8"`; the bytes are copied.
    void text_variable(const VariableInfo& info, std::string bytes);

    /// Attributes above this size would need HDF5's dense storage, which NetCDF does not switch on.
    static constexpr std::size_t max_attribute = 16u << 10;

    /// The finished file; call once. Throws IoError.
    std::string image();

private:
    struct Pending {
        int variable;
        const void* data;
    };

    void define(const VariableInfo& info, int type, const void* data, std::size_t n_values);

    int file_ = -1;
    std::map<std::string, std::pair<int, std::size_t>> dimensions_;   ///< name -> id, length
    std::vector<Pending> pending_;
    std::deque<std::string> texts_;
};

/// Reads a file. Every size is checked against the size of the image before memory is asked for.
class NetcdfReader {
public:
    /// Throws IoError if the image is no NetCDF-4 file. The image must outlive the reader.
    explicit NetcdfReader(std::string& image);
    ~NetcdfReader();
    NetcdfReader(const NetcdfReader&) = delete;
    NetcdfReader& operator=(const NetcdfReader&) = delete;

    std::size_t dimension(const std::string& name) const;   ///< 0 if there is none

    bool has_attribute(const std::string& name) const;
    std::string text_attribute(const std::string& name) const;
    long long int_attribute(const std::string& name) const;
    double double_attribute(const std::string& name) const;
    int int_attribute_of(const std::string& variable, const std::string& name) const;

    std::vector<std::string> attributes() const;   ///< names of the global ones
    std::vector<std::string> variables() const;    ///< names
    std::string text_attribute_of(const std::string& variable, const std::string& name) const;

    bool has_variable(const std::string& name) const;
    /// Throw IoError: missing, dimensions other than those of `info`, another type, too large for the file.
    std::vector<double> doubles(const VariableInfo& info) const;
    std::vector<int> ints(const VariableInfo& info) const;
    std::vector<signed char> bytes(const VariableInfo& info) const;
    std::string text(const VariableInfo& info) const;

private:
    int find(const std::string& variable) const;
    std::string text_attribute(int variable, const std::string& name) const;
    std::size_t check(const VariableInfo& info, int type, std::size_t value_size, int& variable) const;

    int file_ = -1;
    std::size_t image_size_ = 0;
};

}   // namespace livens
