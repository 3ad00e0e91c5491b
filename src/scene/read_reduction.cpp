#include <fmt/format.h>

#include <algorithm>

#include "readers.h"

namespace floe::scene {
namespace {

ModesSpec read_modes(Document& document, Reading& reduction) {
  ModesSpec modes;
  const Value value = *reduction.value("modes");
  modes.where = value.where;
  const bool only_count = value.node.IsScalar();
  Reading reading(document, only_count ? Value{YAML::Node(YAML::NodeType::Map), value.where} : value, "modes");
  modes.count = only_count ? read_integer(document, value, reading.key("count")) : reading.integer("count");
  modes.given = only_count ? reduction.given("modes") : reading.given("count");
  modes.alone = reading.integer("alone");
  modes.of = reading.choice<ModesSpec::Of>("of", {{"joints", ModesSpec::Of::joints}, {"frame", ModesSpec::Of::frame}});
  return modes;
}

void check_pairs(Document& document, const DerivativesSpec& derivatives, const ModesSpec& modes) {
  for (auto pair = derivatives.pairs.begin(); pair != derivatives.pairs.end(); ++pair) {
    const auto [i, j] = *pair;
    if (j > modes.count || i > modes.count) {
      document.fault(derivatives.where, fmt::format("[{}, {}] refers to mode {}", i, j, std::max(i, j)),
                     fmt::format("at most {}, the count of modes", modes.count));
    } else if (i > j) {
      document.fault(derivatives.where, fmt::format("is [{}, {}]", i, j), fmt::format("[{}, {}]: i <= j", j, i));
    } else if (std::count(derivatives.pairs.begin(), pair, *pair) > 0) {
      document.fault(derivatives.where, fmt::format("[{}, {}] is given twice", i, j));
    }
  }
}

DerivativesSpec read_derivatives(Document& document, Reading& reduction, const ModesSpec& modes) {
  using Choice = DerivativesSpec::Choice;
  DerivativesSpec derivatives;
  const Value value = *reduction.value("derivatives");
  const Key& key = reduction.key("derivatives");
  derivatives.where = value.where;
  derivatives.full = reduction.choice("derivative_type") == "full";
  const std::size_t before = document.fault_count();
  const std::string word = value.node.IsScalar() ? value.node.Scalar() : "";
  if (value.node.IsSequence()) {
    derivatives.choice = Choice::pairs;
    derivatives.pairs = read_pairs(document, value, key);
    if (document.fault_count() == before) check_pairs(document, derivatives, modes);
  } else if (word == "all") {
    derivatives.choice = Choice::all;
  } else if (word == "none") {
    derivatives.choice = Choice::none;
  } else if (!word.empty() && word.find_first_not_of("+-.0123456789") == std::string::npos) {
    Key count = key;
    count.range = {0, 1e8};
    derivatives.choice = Choice::count;
    derivatives.count = read_integer(document, value, count);
    const double all = 0.5 * modes.count * (modes.count + 1.0);
    if (derivatives.count > all) {
      document.fault(value.where, fmt::format("is {}", derivatives.count),
                     fmt::format("at most {}, all derivatives of {} modes", all, modes.count));
    }
  } else {
    document.fault(value.where, shown(value.node), describe(key), word, {"all", "none"});
  }
  return derivatives;
}

std::optional<double> read_products(Document& document, Reading& reduction) {
  if (!reduction.given("products")) return {};
  const Value value = *reduction.value("products");
  if (value.node.IsScalar() && value.node.Scalar() == "all") return 0;
  const std::string word = value.node.IsScalar() ? value.node.Scalar() : "";
  if (word.empty() || word.find_first_not_of("+-.0123456789eE %") != std::string::npos) {
    document.fault(value.where, shown(value.node), describe(reduction.key("products")), word, {"all"});
    return {};
  }
  const std::size_t before = document.fault_count();
  const double share = read_share(document, value, reduction.key("products"));
  return document.fault_count() == before ? std::optional(share) : std::nullopt;
}

}  // namespace

ReductionSpec read_reduction(Document& document, const Value& value, const std::string& body) {
  using Attachment = ReductionSpec::Attachment;
  ReductionSpec reduction;
  Reading reading(document, value, "reduction");
  reduction.modes = read_modes(document, reading);
  reduction.derivatives = read_derivatives(document, reading, reduction.modes);
  reduction.attachment = reading.choice<Attachment>("attachment", {{"none", Attachment::none},
                                                                   {"joints", Attachment::joints},
                                                                   {"loads", Attachment::loads},
                                                                   {"all", Attachment::all}});
  if (const auto places = reading.value("interface"); places && reading.given("interface"))
    for (const Value& place : read_list(document, *places, reading.key("interface")))
      reduction.interface.push_back(read_own_place(document, place, reading.key("interface"), body));
  if (!reduction.interface.empty() && reduction.modes.of == ModesSpec::Of::frame)
    document.fault(reading.where("interface"), "cannot be combined with modes: {of: frame}", "modes: {of: joints}");
  if (const auto columns = reading.value("columns"); columns && reading.given("columns")) {
    reduction.columns_where = reading.where("columns");
    reduction.columns = read_texts(document, *columns, reading.key("columns"));
    if (reading.given("derivatives"))
      document.fault(reading.where("derivatives"), "cannot be combined with columns, which lists the derivatives",
                     "one of them");
  }
  reduction.responses = reading.integer("responses");
  if (reading.given("responses")) reduction.responses_where = reading.where("responses");
  reduction.linear = reading.choice("elastic_force") == "linear";
  reduction.products = read_products(document, reading);
  reduction.interface_degree = reading.integer("interface_degree");
  reduction.drop_tolerance = reading.number("drop_tolerance");
  return reduction;
}

void check_responses(Document& document, const Scene& scene) {
  const bool changes = std::any_of(scene.events.begin(), scene.events.end(),
                                   [](const Event& event) { return event.kind != Event::Kind::stop; });
  for (const Body& body : scene.bodies) {
    if (body.reduction.responses == 0) continue;
    const Where& where = body.reduction.responses_where;
    if (scene.motion.end == 0)
      document.fault(where, "needs a preliminary simulation of the scene, which has no motion", "`motion`");
    if (changes)
      document.fault(where, "cannot be combined with events that change joints",
                     "no responses, or events that only end the simulation");
  }
}

}  // namespace floe::scene
