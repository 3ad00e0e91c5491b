#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "reduced_file_hdf5.h"
#include "reduced_file_image.h"

namespace floe::output {
namespace {

using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

Eigen::MatrixXd matrix_at(const double* data, Eigen::Index rows, Eigen::Index columns) {
  return Eigen::Map<const Rows>(data, rows, columns);
}

Eigen::MatrixXd read_matrix(hid_t file, const std::string& name, Extent&& shape) {
  const auto data = read_whole<double>(file, name, shape);
  return matrix_at(data.data(), shape[0], shape[1]);
}

Eigen::VectorXd read_vector(hid_t file, const std::string& name, hsize_t size) {
  const auto data = read_whole<double>(file, name, {size});
  return Eigen::Map<const Eigen::VectorXd>(data.data(), data.size());
}

std::int64_t read_integer(hid_t file, const std::string& name, std::int64_t least, std::int64_t most) {
  const auto value = read_whole<std::int64_t>(file, name, {}).front();
  if (value < least || value > most)
    fail(name, fmt::format("a number from {} to {}", least, most), fmt::format("{}", value));
  return value;
}

std::int64_t read_count(hid_t file, const std::string& name) {
  return read_integer(file, name, 0, std::numeric_limits<std::int64_t>::max());
}

std::vector<std::string> read_list(hid_t file, const std::string& name, std::size_t count) {
  auto texts = read_texts(file, name);
  if (texts.size() != count) fail(name, fmt::format("{} texts", count), fmt::format("{}", texts.size()));
  return texts;
}

body::Inertia read_inertia(hid_t file, const std::string& group, int dimension, int coordinates) {
  const hsize_t d = dimension, k = coordinates;
  body::Inertia inertia(dimension, coordinates);
  inertia.m = read_whole<double>(file, group + "/m", {}).front();
  inertia.s0 = read_vector(file, group + "/s0", d);
  inertia.C0 = read_matrix(file, group + "/C0", {d, d});
  inertia.S = read_matrix(file, group + "/S", {d, k});
  const auto h = read_whole<double>(file, group + "/h", {d, d, k});
  const auto M = read_whole<double>(file, group + "/M", {d, d, k, k});
  for (hsize_t a = 0; a < d; ++a)
    for (hsize_t b = 0; b < d; ++b) {
      inertia.h[a][b] = matrix_at(h.data() + (a * d + b) * k, k, 1);
      inertia.M[a][b] = matrix_at(M.data() + (a * d + b) * k * k, k, k);
    }
  if (H5Lexists(file, (group + "/Q").c_str(), H5P_DEFAULT) > 0) {
    const auto Q = read_whole<double>(file, group + "/Q", {d, k, k});
    inertia.allocate_first();
    for (hsize_t a = 0; a < d; ++a) inertia.Q[a] = matrix_at(Q.data() + a * k * k, k, k);
  }
  if (H5Lexists(file, (group + "/W").c_str(), H5P_DEFAULT) <= 0) return inertia;
  const auto W = read_whole<double>(file, group + "/W", {d, d, k, k});
  inertia.allocate_rotary();
  for (hsize_t a = 0; a < d; ++a)
    for (hsize_t b = 0; b < d; ++b) inertia.W[a][b] = matrix_at(W.data() + (a * d + b) * k * k, k, k);
  return inertia;
}

body::Elasticity read_elasticity(hid_t file) {
  body::Elasticity elasticity;
  Extent square{any, any}, pairs{any, 2};
  const auto bending = read_whole<double>(file, "elasticity/bending", square);
  if (square[0] != square[1] || square[0] > std::numeric_limits<int>::max())
    fail("elasticity/bending", "a square matrix", fmt::format("{} x {}", square[0], square[1]));
  const hsize_t k = square[0];
  elasticity.bending = matrix_at(bending.data(), k, k);
  const auto numbers = read_whole<std::int64_t>(file, "elasticity/pairs", pairs);
  for (hsize_t i = 0; i < pairs[0]; ++i) {
    const std::int64_t a = numbers[2 * i], b = numbers[2 * i + 1];
    if (a < 0 || a > b || b >= static_cast<std::int64_t>(k))
      fail("elasticity/pairs", fmt::format("pairs 0 <= a <= b < {}", k), fmt::format("({}, {}) at row {}", a, b, i));
    elasticity.pairs.emplace_back(a, b);
  }
  elasticity.F = read_matrix(file, "elasticity/F", {any, k + pairs[0]});
  return elasticity;
}

std::vector<ReducedPlace> read_places(hid_t file, hsize_t d, hsize_t k) {
  const auto names = read_texts(file, "places/names");
  const hsize_t n = names.size(), rotations = d == 2 ? 1 : 3;
  const auto x = read_whole<double>(file, "places/x", {n, d});
  const auto S = read_whole<double>(file, "places/S", {n, d, k});
  const auto psi = read_whole<double>(file, "places/psi", {n, rotations, k});
  const bool arms = H5Lexists(file, "places/Q", H5P_DEFAULT) > 0;
  const auto Q = arms ? read_whole<double>(file, "places/Q", {n, d, k, k}) : std::vector<double>();
  const bool turned = H5Lexists(file, "places/H", H5P_DEFAULT) > 0;
  const auto H = turned ? read_whole<double>(file, "places/H", {n, 3, 3, 3}) : std::vector<double>();
  std::vector<ReducedPlace> places;
  for (hsize_t i = 0; i < n; ++i) {
    places.push_back({names[i],
                      {matrix_at(x.data() + i * d, d, 1), matrix_at(S.data() + i * d * k, d, k),
                       matrix_at(psi.data() + i * rotations * k, rotations, k)}});
    std::vector<Eigen::MatrixXd> forms;
    for (hsize_t a = 0; a < d && arms; ++a) forms.push_back(matrix_at(Q.data() + (i * d + a) * k * k, k, k));
    const bool some = std::any_of(forms.begin(), forms.end(), [](const auto& form) { return !form.isZero(0); });
    if (some) places.back().map.Q = std::move(forms);
    const double* own = H.data() + 27 * i;
    if (turned && std::any_of(own, own + 27, [](double entry) { return entry != 0; }))
      for (hsize_t a = 0; a < 3; ++a) places.back().map.H.push_back(matrix_at(own + 9 * a, 3, 3));
  }
  return places;
}

std::vector<ReducedPressure> read_pressures(hid_t file, hsize_t k) {
  std::vector<ReducedPressure> pressures;
  if (H5Lexists(file, "pressure", H5P_DEFAULT) <= 0) return pressures;
  const auto parts = read_texts(file, "pressure/parts");
  const hsize_t n = parts.size();
  const auto read = [&](const char* name, Extent shape) {
    shape.insert(shape.begin(), n);
    return read_whole<double>(file, std::string("pressure/") + name, shape);
  };
  const auto force = read("force", {3}), moment = read("moment", {3}), force_by = read("force_by", {3, k}),
             moment_by = read("moment_by", {3, k}), load = read("load", {k}), load_by = read("load_by", {k, k}),
             spread = read("spread", {3, 3}), spread_by = read("spread_by", {k, 3, 3});
  for (hsize_t i = 0; i < n; ++i) {
    body::Pressure unit(static_cast<Eigen::Index>(k));
    unit.force = matrix_at(force.data() + 3 * i, 3, 1), unit.moment = matrix_at(moment.data() + 3 * i, 3, 1);
    unit.force_by = matrix_at(force_by.data() + 3 * k * i, 3, k);
    unit.moment_by = matrix_at(moment_by.data() + 3 * k * i, 3, k);
    unit.load = matrix_at(load.data() + k * i, k, 1), unit.load_by = matrix_at(load_by.data() + k * k * i, k, k);
    unit.spread = matrix_at(spread.data() + 9 * i, 3, 3);
    for (hsize_t j = 0; j < k; ++j) unit.spread_by[j] = matrix_at(spread_by.data() + 9 * (k * i + j), 3, 3);
    pressures.push_back({parts[i], std::move(unit)});
  }
  return pressures;
}

std::vector<ReducedColumn> read_columns(hid_t file) {
  const auto kind = read_texts(file, "columns/kind");
  const hsize_t n = kind.size();
  const auto label = read_list(file, "columns/label", n);
  const auto omega = read_whole<double>(file, "columns/omega", {n});
  const auto new_part = read_whole<double>(file, "columns/new_part", {n});
  const auto interaction = read_whole<double>(file, "columns/interaction", {n});
  const auto kept = read_whole<std::int64_t>(file, "columns/kept", {n});
  const bool told = H5Lexists(file, "columns/dropped", H5P_DEFAULT) > 0;
  const auto dropped = told ? read_list(file, "columns/dropped", n) : std::vector<std::string>(n);
  std::vector<ReducedColumn> columns;
  for (hsize_t i = 0; i < n; ++i) {
    if (kept[i] != 0 && kept[i] != 1) fail("columns/kept", "0 or 1", fmt::format("{}", kept[i]));
    columns.push_back({kind[i], label[i], omega[i], new_part[i], kept[i] == 1, interaction[i], dropped[i]});
  }
  return columns;
}

MadeBy read_made(hid_t file) {
  MadeBy made{read_text(file, "made/version"), read_text(file, "made/commit"),
              read_text(file, "made/date"),    read_text(file, "made/command"),
              read_text(file, "made/options"), read_text(file, "made/scene"),
              read_count(file, "made/ranks"),  {}};
  const auto phases = read_texts(file, "made/phases");
  const auto seconds = read_whole<double>(file, "made/seconds", {phases.size()});
  for (std::size_t i = 0; i < phases.size(); ++i) made.seconds[phases[i]] = seconds[i];
  return made;
}

/// Other files of floe, other versions, drafts.
void check_kind(hid_t file) {
  const std::string wanted = fmt::format("a reduced body (attribute 'format' = '{}')", reduced_format);
  if (H5Aexists(file, "format") <= 0)
    throw Fault(fmt::format("expected {}, found an HDF5 file of another kind", wanted));
  const Hid format(H5Aopen(file, "format", H5P_DEFAULT), H5Aclose), type(H5Aget_type(format), H5Tclose);
  std::string text(H5Aget_storage_size(format), '\0');
  const bool readable = H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0;
  if (readable) check_hdf5(H5Aread(format, type, text.data()));
  if (!readable || text != reduced_format) throw Fault(fmt::format("expected {}, found another format", wanted));
  if (const auto version = read_flag(file, "version"); version < 1 || version > reduced_version)
    throw Fault(fmt::format("expected version 1 to {} of the format, found version {}", reduced_version, version));
  if (read_flag(file, "complete") != 1) throw Fault("expected a complete file, found one whose writing was broken off");
}

}  // namespace

ReducedBodyFile parse(hid_t file) {
  check_kind(file);
  ReducedBodyFile all;
  all.has_shapes = read_flag(file, "shapes") != 0;
  all.version = static_cast<int>(read_flag(file, "version"));
  all.name = read_text(file, "body/name");
  all.dimension = static_cast<int>(read_integer(file, "body/dimension", 2, 3));
  all.dofs = read_count(file, "body/dofs");
  all.nodes = read_count(file, "body/nodes");
  all.cells = read_count(file, "body/cells");
  all.body.elasticity = read_elasticity(file);
  if (H5Lexists(file, "elasticity/omitted", H5P_DEFAULT) > 0)
    all.omitted_products = read_count(file, "elasticity/omitted");
  const int d = all.dimension, k = all.body.coordinates();
  all.body.inertia = read_inertia(file, "inertia", d, k);
  all.body.line = read_inertia(file, "line", d, k);
  Extent damping{any, any};
  const auto values = read_whole<double>(file, "damping", damping);
  if (damping != Extent{0, 0} && damping != Extent(2, k))
    fail("damping", fmt::format("{0} x {0} numbers or none", k), fmt::format("{} x {}", damping[0], damping[1]));
  all.damping = matrix_at(values.data(), damping[0], damping[1]);
  if (all.version >= 3) {
    Extent one;
    all.strain_rate_damping = read_whole<double>(file, "strain_rate_damping", one).front();
    if (all.strain_rate_damping < 0 || (all.strain_rate_damping > 0 && all.damping.size() == 0))
      fail("strain_rate_damping", "0, or a positive number with a damping matrix",
           fmt::format("{}", all.strain_rate_damping));
  }
  all.places = read_places(file, d, k);
  all.pressures = read_pressures(file, k);
  all.columns = read_columns(file);
  Extent modes{any};
  all.omega = read_whole<double>(file, "frequencies/omega", modes);
  all.residual = read_whole<double>(file, "frequencies/residual", modes);
  all.frame = {read_text(file, "frame/kind"), read_vector(file, "frame/origin", d),
               read_matrix(file, "frame/axes", {hsize_t(d), hsize_t(d)})};
  if (H5Lexists(file, "frequencies/held", H5P_DEFAULT) > 0) all.held = read_texts(file, "frequencies/held");
  all.made = read_made(file);
  check_contents(all);
  return all;
}

}  // namespace floe::output
