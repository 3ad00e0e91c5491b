#pragma once
#include "nas_reading.h"

namespace floe::mesh {

/// What one card adds to the model.
struct NasReader {
  NasFields& card;
  NasModel& model;

  Where where() const { return card.card.where(); }
  std::string named(const char* kind, long long id) const { return kind + std::to_string(id); }

  /// A card, or a part of it, that is ignored, by the name whose reason is nas_reason's.
  void count_ignored(const std::string& name) {
    model.ignored.try_emplace(name, NasCount{where(), 0}).first->second.times++;
  }

  template <class Map, class Value>
  void define(Map& map, long long id, Value&& value, const char* what) {
    if (card.good() && !map.emplace(id, std::forward<Value>(value)).second)
      card.refuse_card(std::string("defines ") + what + " " + std::to_string(id) + " a second time");
  }
};

// One function a card, or several of one form. Rank-local.
void read_grid(NasReader& r);
void read_axes(NasReader& r);
void read_shell(NasReader& r);
void read_beam(NasReader& r);
void read_rod(NasReader& r);
void read_conrod(NasReader& r);
void read_prod(NasReader& r);
void read_celas(NasReader& r);
void read_pelas(NasReader& r);
void read_cbush(NasReader& r);
void read_pbush(NasReader& r);
void read_conm2(NasReader& r);
void read_conm1(NasReader& r);
void read_cmass(NasReader& r);
void read_pmass(NasReader& r);
void read_rbe2(NasReader& r);
void read_rbar(NasReader& r);
void read_rbe3(NasReader& r);
void read_pshell(NasReader& r);
void read_pcomp(NasReader& r);
void read_pbar(NasReader& r);
void read_pbeam(NasReader& r);
void read_pbarl(NasReader& r);
void read_mat1(NasReader& r);
void read_mat2(NasReader& r);
void read_mat8(NasReader& r);
void read_other_material(NasReader& r);

}  // namespace floe::mesh
