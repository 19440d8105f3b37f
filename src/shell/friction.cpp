#include "shell/friction.h"

namespace plisse::shell {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Contact friction(const Grip& grip, const Vector3d& x, double coefficient, double slip) {
  const Matrix3d along = Matrix3d::Identity() - grip.normal * grip.normal.transpose();
  const Vector3d way = along * (x - grip.anchor);
  const double y = way.norm(), size = coefficient * grip.force;
  Contact contact;
  if (y >= slip) {
    contact.value = size * (y - slip / 3);
    contact.first = size / y * way;
    contact.second = size / y * (along - way * way.transpose() / (y * y));
    return contact;
  }
  contact.value = size * (-y * y * y / (3 * slip * slip) + y * y / slip);
  const double pull = 2 / slip - y / (slip * slip);  // f₀'/y
  contact.first = size * pull * way;
  contact.second = size * pull * along;
  if (y > 0) contact.second -= size / (slip * slip * y) * way * way.transpose();
  return contact;
}

}  // namespace plisse::shell
