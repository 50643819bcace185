"""What a ray that leaves refractive matter sees: environment, opaque meshes, lights."""

from pellucid.surroundings.charts import Reach
from pellucid.surroundings.prepare import Surroundings
from pellucid.surroundings.query import Query

__all__ = ["Query", "Reach", "Surroundings"]
