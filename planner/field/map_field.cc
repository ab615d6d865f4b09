#include "planner/field/map_field.h"

#include "planner/field/executor.h"
#include "planner/field/map_field_on.h"

namespace jaywalk::field {

std::unique_ptr<MapField> make_cpu_map_field(CellMap map) {
  return std::make_unique<MapFieldOn<SerialExecutor>>(std::move(map), std::make_unique<SerialExecutor>());
}

}  // namespace jaywalk::field
