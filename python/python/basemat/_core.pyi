"""The compiled half of basemat.

Written by ``tools/stubs.py`` from the Rust sources and the compiled module.
"""

import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any, ClassVar, Literal, Union, final, overload

import numpy as np
from matplotlib.animation import FuncAnimation
from matplotlib.axes import Axes
from numpy.typing import ArrayLike, NDArray
from pandas import DataFrame
from pyvista import UnstructuredGrid
from typing_extensions import Self, TypeAlias, disjoint_base
from xarray import Dataset

from ._protocols import (
    Mode as Mode,
    UserGround,
    UserHysteresis,
    UserLaw,
    UserMaterial,
    UserPlanLaw,
    UserStructure,
    UserUniaxialMaterial,
)

__version__: str
MODES: list[Mode]
"""Names of the contact modes, in the order of their numbers in arrays."""
_ELEMENT_UNITS: dict[str, str]
STANDARD_GRAVITY: float
"""9.80665 m/s²."""

_History: TypeAlias = Literal["auto", "direct", "relaxed_fft", "exponentials"]
_Grading: TypeAlias = Literal["cosine", "uniform"]
_StripContact: TypeAlias = Literal["bonded", "relaxed"]
_FrictionLimit: TypeAlias = Literal["total", "lagged", "static", "dynamic"]
_SlipSense: TypeAlias = Literal["inelastic", "velocity", "last_velocity"]
_AccelerationUnit: TypeAlias = Literal["m/s²", "mm/s²", "g", "gal", "ft/s²", "in/s²"]
_RecordFormat: TypeAlias = Literal[
    "columns",
    "along_lines",
    "peer",
    "cosmos",
    "k_net",
    "k_net_csv",
    "esm",
    "afad",
    "slist",
    "smc",
    "geonet",
]
_Baseline: TypeAlias = Literal[
    "remove_mean",
    "newmark_parabola",
    "velocity_polynomial",
    "displacement_polynomial",
    "rest_to_rest",
]
_AbrahamsonModel: TypeAlias = Literal[
    "hard_rock_horizontal", "hard_rock_vertical", "soil_horizontal", "soil_vertical"
]
_CurveBound: TypeAlias = Literal["mean", "upper"]
_Wave: TypeAlias = Literal["shear", "pressure"]
_ControlPoint: TypeAlias = Literal["outcrop", "within"]
_InclinedControl: TypeAlias = Literal["outcrop_horizontal", "outcrop_vertical", "incident"]
_Change: TypeAlias = Literal["interface_law", "ground_motion", "load", "gravity_stage", "initial_motion"]
_GravityStage: TypeAlias = Literal["frictionless", "frictional", "wished_in_place", "unloaded"]
_Coordinates: TypeAlias = Literal["auto", "physical", "modes"]
_SectionUnit: TypeAlias = Literal["N/m", "N·m/m", "N", "N·m"]
_Face: TypeAlias = Literal["left_wall", "base", "right_wall"]
_PlanDirection: TypeAlias = Literal["x", "y", "xy", "twist"]
_Mass: TypeAlias = Literal["consistent", "lumped"]
_Formulation: TypeAlias = Literal["incompatible_modes", "full", "one_point", "hourglass", "mean_dilatation"]
_Direction: TypeAlias = Literal["x", "y", "rotation", "z", "rotation_x", "rotation_y", "rotation_z"]
_SpringDirection: TypeAlias = Literal[
    "x", "y", "rotation", "z", "rotation_x", "rotation_y", "rotation_z", "axial"
]

_Ground: TypeAlias = Union["Ground", UserGround]
_Interface: TypeAlias = Union["InterfaceLaw", UserLaw, UserPlanLaw]
_Quantity: TypeAlias = Literal[
    "base_shear",
    "base_moment",
    "normal_force",
    "uplifted_fraction",
    "mean_slip",
    "largest_slip",
    "base_rotation",
    "settlement",
    "rocking_work",
    "free_field_horizontal",
    "free_field_vertical",
    "sliding_safety",
    "overturning_safety",
    "shear_across",
    "horizontal_force",
    "moment_across",
    "torque",
    "uplifted_area",
    "mean_slip_across",
    "rotation_across",
    "rocking_work_across",
    "twist",
    "free_field_across",
    "overturning_safety_across",
]
_Structure: TypeAlias = Union["Structure", UserStructure]
_Base: TypeAlias = Union[Sequence["BaseNode"], Sequence[Sequence["BaseNode"]], "BaseFaces"]
_RowLike: TypeAlias = Union[
    "DofCombination", int, Mapping[int, float], Sequence[tuple[int, float]], NDArray[np.float64]
]
_Spring: TypeAlias = Union[
    tuple[_RowLike, Union["Hysteresis", UserHysteresis]],
    tuple[_RowLike, _RowLike, "Hysteresis"],
    tuple[_RowLike, _RowLike, _RowLike, "PendulumBearing"],
]
_GmshPart: TypeAlias = Union[
    "Material", tuple["Material", float], tuple["Material", "BeamSection", Sequence[float]], None
]
_Solid: TypeAlias = Union["Material", "Iwan", "DruckerPrager", UserMaterial]
_FiberLaw: TypeAlias = Union[
    "Concrete", "BilinearSteel", "BilinearMoment", "MenegottoPinto", "Material", UserUniaxialMaterial
]
_ShellAxes: TypeAlias = Union[ArrayLike, Callable[[float, float, float], ArrayLike]]
_MatrixLike: TypeAlias = Any
"""A square array, or any matrix of ``scipy.sparse``."""

@final
class BaseNode:
    """A node of the base: its coordinate ``x`` (m), and the rows (`DofCombination` or its ``terms``) of its displacement
    to the right, ``horizontal``, and up, ``vertical``. In plan also its coordinate ``y`` (away from the reader, m; zero
    unless given) and the row of its displacement along y, ``across``. On walls and bases below the surface also its
    height ``z`` above the surface (m, negative; zero unless given).
    """

    def __new__(
        cls,
        x: float,
        horizontal: _RowLike,
        vertical: _RowLike,
        *,
        y: float = 0.0,
        across: _RowLike | None = None,
        z: float = 0.0,
    ) -> Self: ...
    @staticmethod
    def rigid(x: float, center: float, dofs: Sequence[int]) -> BaseNode:
        """A node at ``x`` (m) of a rigid flat base whose degrees of freedom at ``center`` (x, m) have the
        numbers ``dofs`` (horizontal, vertical, rotation).
        """
    @staticmethod
    def rigid_base(left: float, right: float, dofs: Sequence[int]) -> list[BaseNode]:
        """The two ends, a list, of a rigid flat base from ``left`` to ``right`` (m) whose degrees of freedom
        at its middle have the numbers ``dofs`` (horizontal, vertical, rotation).
        """
    @staticmethod
    def rigid_face(
        corners: Sequence[Sequence[float]],
        center: Sequence[float],
        dofs: Sequence[int],
    ) -> list[BaseNode]:
        """The face, a list of its corners, of a rigid flat base in plan: ``corners`` (list of x and y, m) from ``center``
        (x and y, m), whose displacements along x, along y and up and rotations about these axes have the numbers
        ``dofs`` (six).
        """
    @property
    def x(self) -> float:
        """Coordinate to the right, m."""
    @property
    def y(self) -> float:
        """Coordinate away from the reader, m; zero in the plane."""
    @property
    def z(self) -> float:
        """Height above the surface, m; negative below it."""
    @property
    def horizontal(self) -> DofCombination:
        """The `DofCombination` of its displacement to the right."""
    @property
    def across(self) -> DofCombination:
        """The `DofCombination` of its displacement along y; empty in the plane."""
    @property
    def vertical(self) -> DofCombination:
        """The `DofCombination` of its displacement up."""

@final
class BaseFaces:
    """The base of a structure in plan: ``faces``, a list of lists of `BaseNode`. An iteration yields these lists.

    A face is a convex polygon, given by its corners in either order, flat and at one height. A rigid base needs one
    face, its outline, which may be given without a list. Faces that touch are one foundation.
    """

    def __new__(cls, faces: Sequence[BaseNode] | Sequence[Sequence[BaseNode]]) -> Self: ...
    def __len__(self) -> int: ...
    def __iter__(self) -> Iterator[list[BaseNode]]: ...

@final
class BearingFactors:
    """Bearing capacity factors of drained soil under a rough strip.

    ``friction_angle`` of the soil: rad. Source: EN 1997-1:2004, D.4.
    """

    def __new__(cls, friction_angle: float) -> Self: ...
    @property
    def cohesion(self) -> float:
        """Factor N_c of the cohesion, a number; π + 2 without friction."""
    @property
    def surcharge(self) -> float:
        """Factor N_q of the pressure of the soil beside the base, a number."""
    @property
    def unit_weight(self) -> float:
        """Factor N_γ of the unit weight of the soil below the base, a number."""
    def __eq__(self, value: object, /) -> bool: ...

@final
class ShallowFooting:
    """Rectangular shallow footing, or a `circle`, for its bearing capacity.

    The capacity follows EN 1997-1:2004, Annex D, without partial factors.

    ``sides`` along x and y (m); with ``math.inf`` along y it is a strip, whose forces are per metre. ``surcharge``: vertical
    pressure of the soil beside the base at its level (Pa; 0 by default), unit weight times depth. ``eccentricity`` of the
    load along x and y (m; (0, 0) by default). ``vertical_force`` and ``horizontal_force`` (along x and y) of a load whose
    inclination reduces the capacity (N; 0 by default). ``base_tilt`` of the base against the horizontal (rad; 0 by default).

    The result of `drained_pressure` is the ``bearing_pressure`` for `Yielding` and `CyclicYielding`.
    """

    def __new__(
        cls,
        sides: Sequence[float],
        *,
        surcharge: float = 0.0,
        eccentricity: tuple[float, float] = (0.0, 0.0),
        vertical_force: float = 0.0,
        horizontal_force: tuple[float, float] = (0.0, 0.0),
        base_tilt: float = 0.0,
    ) -> Self: ...
    @staticmethod
    def circle(
        diameter: float,
        *,
        surcharge: float = 0.0,
        vertical_force: float = 0.0,
        horizontal_force: tuple[float, float] = (0.0, 0.0),
        base_tilt: float = 0.0,
    ) -> ShallowFooting:
        """Circular footing of a ``diameter`` (m), loaded in its middle. ``surcharge``, ``vertical_force``,
        ``horizontal_force`` and ``base_tilt`` are as in the constructor.
        """
    @property
    def effective_sides(self) -> list[float]:
        """Effective sides along x and y, m."""
    @property
    def effective_area(self) -> float:
        """Effective area, m²; of a strip its effective width, m²/m."""
    def drained_pressure(self, strength: SoilStrength, unit_weight: float) -> float:
        """Bearing pressure (Pa) of drained soil of a ``strength`` (`SoilStrength`) on the effective area. ``unit_weight`` of the
        soil below the base, N/m³.
        """
    def pressure_growth(self, strength: SoilStrength, unit_weight: float) -> float:
        """Increase of the drained bearing pressure with the settlement of the base (Pa/m), for a ``strength`` and
        ``unit_weight`` as in `drained_pressure`: the product of N_q, the unit weight and the factors of shape,
        inclination and tilt.
        """
    def undrained_pressure(self, undrained_strength: float) -> float:
        """Bearing pressure (Pa) of undrained soil of an ``undrained_strength`` (Pa) on the effective area."""
    def rocking_capacity(self, vertical_force: float, bearing_pressure: float) -> tuple[float, list[float]]:
        """Ratio of the critical contact area to the area of the base, and the moments (N·m) at which the footing rocks
        along x and along y, under a ``vertical_force`` (N) on soil of a ``bearing_pressure`` (Pa). The moment of a
        rectangle is V L/2 (1 − A_c/A) (Gajan and Kutter 2008).
        """
    def __eq__(self, value: object, /) -> bool: ...

@final
class _CaseFile:
    """The file at ``path`` of the cases of a grid, or of its ``shard`` (its index, number of shards): rows are appended
    while cases run.
    """

    def __new__(
        cls,
        path: str | os.PathLike[str],
        grid: Sequence[tuple[str, Any]],
        shard: tuple[int, int] | None = None,
    ) -> Self: ...
    def rows(self) -> tuple[list[str], list[tuple[int, list[float] | None, str | None, str | None]]]:
        """Columns of results, and the rows so far: number of the case, results, warnings, error."""
    def append(
        self,
        case: int,
        names: Sequence[str],
        results: Any,
        warnings: str | None,
        error: str | None,
    ) -> None:
        """Appends the row of a case: ``results`` under ``names``, or the text of its ``error``."""
    def finish(self) -> tuple[list[str], list[tuple[int, list[float] | None, str | None, str | None]]]:
        """Writes the whole file at once and returns its rows as `rows` does."""

@final
class SharedKernels:
    """Convolution weights that grounds of equal soil and elements share.

    They are computed once for all simulations that are built with the same object. A copy in another process is empty;
    ``len()`` is the number of stored sets.
    """

    def __new__(cls) -> Self: ...
    def __getnewargs__(self) -> tuple[()]: ...
    def __len__(self) -> int: ...

@disjoint_base
class Ground:
    """A ground: a description from which each simulation builds a separate ground."""

    @property
    def elements(self) -> NDArray[np.float64]:
        """Ends of the contact elements along x, from left to right in the plane: array of shape (elements, 2), m. Both
        ends are equal on a wall.
        """
    @property
    def heights(self) -> NDArray[np.float64]:
        """Lower and upper end of the contact elements: array of shape (elements, 2), m above the surface; zero on it."""
    @property
    def depths(self) -> NDArray[np.float64]:
        """Front and back ends of the contact elements along y in plan: array of shape (elements, 2), m; −½ and ½, the
        metre of thickness, in the plane.
        """

@final
class ElasticGround(Ground):
    """Elastic ground, homogeneous or layered, with contact elements on its surface.

    ``soil``: a `Soil` (a half-plane) or a `SoilProfile` (layers). ``strips``: a `Strip` or a list of them, or a `Plan`
    in three dimensions.

    ``history``: method that sums the response to all past tractions: "auto" (the default: exponentials on a half-plane
    under strips, otherwise transforms), "direct", "relaxed_fft" or, without layers and damping, "exponentials".
    ``history_tolerance``: permitted relative error of exponentials, 1e-12 to 1e-2 (unless given, 1e-12 with "auto" and
    1e-10 with "exponentials"); ``history_memory``: largest memory of the history, bytes (1 GiB unless given).
    ``kernels``: `SharedKernels` of several simulations; not shared unless given. For layers and damping: ``stages``: 2
    or 3 Runge–Kutta stages (chosen by a rule unless given); ``tolerance``: relative error of the element compliances,
    1e-13 to 1e-4 (1e-10 unless given); ``kernel_file``: path of a file that stores them (none unless given).
    """

    def __new__(
        cls,
        soil: Soil | SoilProfile,
        strips: Strip | Sequence[Strip] | Plan,
        *,
        history: _History = "auto",
        history_tolerance: float | None = None,
        history_memory: int | None = None,
        stages: int | None = None,
        tolerance: float | None = None,
        kernel_file: str | os.PathLike[str] | None = None,
        kernels: SharedKernels | None = None,
    ) -> Self: ...
    @staticmethod
    def under(
        soil: Soil | SoilProfile,
        structure: _Structure,
        count: int,
        *,
        grading: _Grading = "cosine",
        history: _History = "auto",
        history_tolerance: float | None = None,
        history_memory: int | None = None,
        stages: int | None = None,
        tolerance: float | None = None,
        kernel_file: str | os.PathLike[str] | None = None,
        kernels: SharedKernels | None = None,
    ) -> ElasticGround:
        """Ground with contact elements under the foundations of a ``structure``.

        It has a strip of ``count`` elements under each foundation, as wide as the foundation; under a structure in plan
        a `Plan` with ``count`` cells along the shorter side of its base, cut at an outline that is oblique to them. A
        flexible base gets at least one element for each of its segments, or as many cells as it has faces; if
        necessary, ``count`` is raised for this. ``print(ground)`` shows its number of elements, which is also
        ``len(ground.elements)``.

        ``soil`` and the options are as in the class, whose defaults they have unless given: ``history``,
        ``history_tolerance``, ``history_memory``, ``stages``, ``tolerance``, ``kernel_file`` and ``kernels``.
        ``grading``: "cosine" (the default: short at the edges) or "uniform".
        """
    def impedances(self, frequencies: ArrayLike, *, contact: _StripContact = "bonded") -> Any:
        """Dynamic stiffness of all strips as one rigid body, `Impedances`, at ``frequencies`` (array of shape (m,), Hz);
        in plan the array of `Plan.impedances`. ``contact``: "bonded" (the default: soil and strips move together) or
        "relaxed" (vertical motions without shear, horizontal motions without pressure).
        """

@final
class NearField:
    """Box of soil around a foundation at the surface, as finite elements that may yield.

    The box begins at rest (`Mesh.with_stress_at_rest`) and fills a trench, to which it is bonded: the law of the trench is
    `Bonded`. The foundation is added to `mesh` by common nodes at the surface, or stands on it by a joint
    (`Joint.around_nodes`); `ground` is the soil around the box, which stays linear. Elements must be shorter than an
    eighth of the shortest wave of interest, and have no viscous damping, whatever that of the profile.

    ``soil``: `Soil` or `SoilProfile`. ``half_width``: half the width of the foundation, whose middle is x = 0, m.
    ``size``: half width and depth of the box (m), 2 and 1 times the half width of the foundation unless given.
    ``foundation_elements``: number of elements under the foundation, an even number; 6 unless given.
    ``pressure_at_rest``: gravity (m/s²) and K₀, the ratio of horizontal to vertical pressure at rest; standard gravity and
    ν/(1 − ν) of each soil unless given. ``strength_profile``: a function of the depth (m) that returns the strength s_u of
    clay without drainage (Pa), which is `Iwan.hyperbolic` with the constants of the profile, and reaches s_u at a strain of
    200 s_u/G; the soil is elastic unless given.
    """

    def __new__(
        cls,
        soil: Soil | SoilProfile,
        half_width: float,
        *,
        size: Sequence[float] | None = None,
        foundation_elements: int | None = None,
        pressure_at_rest: Sequence[float] | None = None,
        strength_profile: Callable[[float], float] | None = None,
    ) -> Self: ...
    def mesh(self) -> Mesh:
        """`Mesh` of the box at rest, whose surface has nodes at both ends of the foundation; for a
        ``FemModel(mesh, on_soil_at_rest=True)``.
        """
    def foundation_nodes(self, mesh: Mesh) -> list[int]:
        """Numbers of the nodes of the surface under the foundation, from left to right: list. ``mesh``: a `Mesh` that begins with
        that of `mesh`. A welded foundation has these nodes in common with the soil; a joint takes them as its lower side.
        """
    def ground(self, *, kernels: SharedKernels | None = None) -> TrenchGround:
        """`TrenchGround` of the soil around the box. ``kernels``: `SharedKernels` of several grounds; none unless given."""

@final
class Plan:
    """Square contact cells under a mat, for an `ElasticGround` in plan.

    They are the cells that the ``faces`` of the mat cover, convex polygons by their corners (list of lists of x and y,
    m; a single face needs no list around it), with ``cells`` along the shorter side of all faces together. Oblique
    edges cut the cells; at straight edges along x and y the cells extend beyond the edge by 0.105 of their side.
    """

    def __new__(cls, faces: Sequence[Any], cells: int) -> Self: ...
    @staticmethod
    def disc(center: tuple[float, float], radius: float, cells: int) -> Plan:
        """Disc around ``center`` (x and y, m) of a ``radius`` (m), with ``cells`` along its diameter."""
    @staticmethod
    def masked(corner: Sequence[float], pitch: Sequence[float], mask: Any) -> Plan:
        """Cells of the sides ``pitch`` (along x and y, m) where ``mask`` is True or 1, and not where it is False or 0. The
        mask is a list of rows in the direction of y, from the ``corner`` (x and y, m) on; each row is a list from left
        to right.
        """
    @property
    def pitch(self) -> list[float]:
        """Sides of a cell along x and y, m."""
    @property
    def middle(self) -> list[float]:
        """Middle of the bounding rectangle, x and y, m: the reference point of impedances."""
    @property
    def area_error(self) -> float:
        """Area of the cells inside the outline minus the area of the faces, relative to the area of the faces."""
    def with_unions(self, along: Sequence[int], across: Sequence[int]) -> Plan:
        """The plan with contact elements that are rectangles of cells: the list ``along`` contains the numbers of columns
        that are united, ``across`` the numbers of rows. Under a rigid mat, sixteen cells united by 1, 2, 2, 3, 3, 2, 2,
        1 are as accurate as separate cells.
        """
    def without_overhang(self) -> Plan:
        """The plan with cells that end at the edges of the faces: for springs, for prescribed pressures and for flexible
        faces.
        """
    def __len__(self) -> int: ...
    def impedances(
        self,
        soil: Soil | SoilProfile,
        frequencies: ArrayLike,
        *,
        contact: _StripContact = "bonded",
    ) -> NDArray[np.complex128]:
        """Dynamic stiffness of the mat as one rigid body on a ``soil``.

        It applies to a ``soil`` (`Soil` or `SoilProfile`) and motions e^(iωt) at ``frequencies`` (array of shape (m,),
        Hz): complex array of shape (m, 6, 6), forces along x, y and z (N) and moments about these axes (N m) per
        displacement (m) and rotation (rad) of the mat's middle. ``contact``: "bonded" (the default) or "relaxed"
        (vertical motions without shear, horizontal motions without pressure).
        """

@final
class SpringGround(Ground):
    """Independent springs and dashpots under each element (Winkler bed).

    ``strips``: a `Strip` or a list of them, or a `Plan`, whose outer cells then end at the edge of the mat.
    ``normal_stiffness``, ``tangential_stiffness``: Pa/m. ``across_stiffness``: tangential stiffness along y in plan,
    Pa/m; equal to ``tangential_stiffness`` unless given. ``dashpots``: coefficients of the normal and the tangential
    dashpots, Pa s/m; none unless given. ``theta``: θ of the time integration of the dashpots, ½ to 1; ½ unless given.
    """

    def __new__(
        cls,
        strips: Strip | Sequence[Strip] | Plan,
        normal_stiffness: float,
        tangential_stiffness: float,
        *,
        across_stiffness: float | None = None,
        dashpots: Sequence[float] | None = None,
        theta: float | None = None,
    ) -> Self: ...
    @staticmethod
    def under(
        structure: _Structure,
        count: int,
        normal_stiffness: float,
        tangential_stiffness: float,
        *,
        across_stiffness: float | None = None,
        dashpots: Sequence[float] | None = None,
        theta: float | None = None,
    ) -> SpringGround:
        """Spring bed with contact elements under the foundations of a ``structure``.

        It has a strip of ``count`` equal elements under each foundation; under a structure in plan ``count`` cells
        along the shorter side of its base; ``normal_stiffness``, ``tangential_stiffness`` (Pa/m), ``across_stiffness``,
        ``dashpots`` and ``theta`` are as in the class; the last three have its defaults unless given. A flexible base
        gets at least one element for each of its segments, or as many cells as it has faces; if necessary, ``count`` is
        raised for this. ``print(ground)`` shows its number of elements, which is also ``len(ground.elements)``.
        """

@final
class Strip:
    """A strip of contact elements from ``left`` to ``right`` (m): ``count`` elements with the ``grading``
    "cosine" (the default: short at the edges, where tractions are singular) or "uniform".
    """

    def __new__(cls, left: float, right: float, count: int, *, grading: _Grading = "cosine") -> Self: ...
    @staticmethod
    def from_nodes(nodes: ArrayLike) -> Strip:
        """Strip of elements between ``nodes`` (array of shape (elements + 1,), m, ascending)."""
    @property
    def nodes(self) -> list[float]:
        """Ends of the elements: list of elements + 1 numbers, m."""

@final
class Impedances:
    """Dynamic stiffness of a rigid base without mass, per metre of thickness.

    It applies to motions e^(iωt). The arrays are complex, of shape (m,), one value per frequency; the imaginary part is
    due to radiation and damping.
    """

    @property
    def frequency(self) -> NDArray[np.float64]:
        """Frequencies: array of shape (m,), Hz."""
    @property
    def horizontal(self) -> NDArray[np.complex128]:
        """Ratio of horizontal force to horizontal translation: complex array of shape (m,), N/m²."""
    @property
    def vertical(self) -> NDArray[np.complex128]:
        """Ratio of vertical force to vertical translation: complex array of shape (m,), N/m²."""
    @property
    def rocking(self) -> NDArray[np.complex128]:
        """Ratio of moment to rotation: complex array of shape (m,), N."""
    @property
    def coupling(self) -> NDArray[np.complex128]:
        """Ratio of horizontal force to rotation: complex array of shape (m,), N/m."""
    def plot(
        self,
        axes: Iterable[Axes] | None = None,
        *,
        label: str | None = None,
        color: str | None = None,
        title: str | None = None,
    ) -> list[Axes]:
        """Draws real and imaginary parts over the frequency; returns the list of four axes.

        ``axes``: four of matplotlib to draw into; unless given, axes of a new figure. For several grounds in the same axes:
        ``label``, a name before the names of the curves, and ``color`` of both. ``title`` stands above the picture; None for
        none.
        """
    def to_frame(self) -> DataFrame:
        """The impedances as a pandas frame of complex numbers, indexed by the frequency (Hz)."""

@final
class Trench:
    """Rectangular trench in the surface of the ground, in the plane.

    It reaches from ``left`` to ``right`` (x, m) and is ``depth`` (m) deep.
    """

    def __new__(cls, left: float, right: float, depth: float) -> Self: ...
    @property
    def sides(self) -> list[float]:
        """x of the left and of the right wall, m."""
    @property
    def depth(self) -> float:
        """Depth of the base below the surface, m."""
    def elements(self, base: int, wall: int) -> TrenchElements:
        """The `TrenchElements`: ``base`` contact elements of the base, an even number, and ``wall`` elements of each wall.

        Elements are shorter towards the ends of each face. With 8 and 6 elements the error of impedances is about 0.5
        %, with twice as many 0.1 %.
        """

@final
class TrenchElements:
    """Contact elements of the faces of a `Trench`: down the left wall, along the base, up the right wall.

    `Trench.elements` creates them; ``len()`` is their number.
    """

    def interfaces(self, base: _Interface, walls: _Interface) -> list[_Interface]:
        """Interface laws of all elements, a list for `Simulation`: the law ``base`` for the base, ``walls`` for both walls (each
        an `InterfaceLaw` or an object with the methods of `UserLaw`).
        """
    def __len__(self) -> int: ...

@final
class TrenchGround(Ground):
    """Soil around a trench, in the plane.

    It is a ``soil`` (`Soil` or `SoilProfile`) with the contact elements of walls and base, ``elements``
    (`TrenchElements`).

    The structure in the trench is a `WithWalls`, or a `FemModel` with ``in_trench``; the ground motion is a
    `TrenchMotion`.

    ``pressure_at_rest``: K₀, the ratio of the pressure on the walls at rest to the vertical pressure of the soil; ν/(1
    − ν) of each soil unless given. ``backfill``: soil beside the walls from the surface to the base, a tuple of the
    width (m) of the backfill, its `Soil` and, if it is damped, its `DampingLaw`; the soil of the profile unless given.
    ``water_table``: a `WaterTable` that presses on base and walls; pressures of the soil are then effective, and densities
    below it those of saturated soil; none unless given.
    ``history``, ``history_tolerance``, ``history_memory``, ``stages``, ``kernel_file`` and ``kernels`` are as for
    `ElasticGround`, and have its defaults unless given.
    """

    def __new__(
        cls,
        soil: Soil | SoilProfile,
        elements: TrenchElements,
        *,
        pressure_at_rest: float | None = None,
        backfill: tuple[float, Soil] | tuple[float, Soil, DampingLaw] | None = None,
        water_table: WaterTable | None = None,
        history: _History = "auto",
        history_tolerance: float | None = None,
        history_memory: int | None = None,
        stages: int | None = None,
        kernel_file: str | os.PathLike[str] | None = None,
        kernels: SharedKernels | None = None,
    ) -> Self: ...
    def impedances(self, frequencies: ArrayLike) -> Impedances:
        """Dynamic stiffness of a rigid body bonded to walls and base, `Impedances`, at ``frequencies`` (array of shape
        (m,), Hz).

        It refers to the middle of the base. Frequency 0 is the static stiffness, on rigid bedrock.
        """
    def interfaces(
        self,
        base: _Interface,
        strengths: SoilStrength | Sequence[SoilStrength],
        *,
        gravity: float = 9.80665,
    ) -> list[_Interface]:
        """Interface laws of all elements, a list for `Simulation`: the law ``base`` for the base (an `InterfaceLaw` or an object
        with the methods of `UserLaw`), and an `EarthPressure` for each element of the walls.

        ``strengths``: a `SoilStrength` of all soils, or a list of one for each soil from the surface down, the
        half-plane last; with backfill, the strength of the backfill alone. ``gravity``: acceleration of gravity, as for
        `InitialConditions`, m/s².
        """
    def kinematic_motions(self, frequencies: ArrayLike) -> KinematicMotions:
        """Motion of a rigid body without mass in the trench, `KinematicMotions`, at ``frequencies`` (array of shape (m,), Hz).

        Shear and pressure waves travel vertically. A ground with backfill raises an error, since waves in it do not
        travel vertically.
        """

@final
class KinematicMotions:
    """Harmonic motion of a rigid body without mass in a trench.

    It is relative to a unit motion e^(iωt) of the surface of the free field.

    It is the input motion of a structure on springs and dashpots. The arrays are complex, of shape (m,), one value per
    frequency. Translations are those of the middle of the base, vertical translations positive down; a positive
    rotation lowers the right end.
    """

    @property
    def frequency(self) -> NDArray[np.float64]:
        """Frequencies: array of shape (m,), Hz."""
    @property
    def horizontal(self) -> NDArray[np.complex128]:
        """Horizontal translation due to horizontal motion (shear waves): complex array of shape (m,), a ratio."""
    @property
    def rotation(self) -> NDArray[np.complex128]:
        """Rotation due to horizontal motion (shear waves): complex array of shape (m,), 1/m."""
    @property
    def vertical(self) -> NDArray[np.complex128]:
        """Vertical translation due to vertical motion (pressure waves): complex array of shape (m,), a ratio."""
    def to_frame(self) -> DataFrame:
        """The motions as a pandas frame of complex numbers, indexed by the frequency (Hz)."""

@disjoint_base
class InterfaceLaw:
    """A law between base and ground: the limits of an element's tractions, and in the plane its contact modes (see
    `MODES`) and the conditions that each of them imposes.
    """

    @property
    def modes(self) -> list[Mode]:
        """List of the names of the modes that this law uses; the first is the mode of an element at rest."""
    def conditions(self, mode: Mode, start: PreviousContact) -> tuple[Condition, Condition]:
        """The two `Condition` that ``mode`` imposes at the end of a step that begins with ``start`` (`PreviousContact`)."""
    def next_mode(
        self,
        mode: Mode,
        start: PreviousContact,
        trial: ContactState,
        tolerance: Tolerance,
    ) -> Mode:
        """The mode to try next after the ``trial`` (`ContactState`) that ``mode`` led to in the step that begins with
        ``start``; ``mode`` itself if the trial is admissible apart from differences below the ``tolerance``.
        """
    def limits(self, start: PreviousContact) -> Limits:
        """The `Limits` of an element's tractions in the step that begins with ``start`` (`PreviousContact`)."""

@final
class Bonded(InterfaceLaw):
    """Base and ground are bonded: they neither separate nor slide."""

    def __new__(cls) -> Self: ...

@final
class Coulomb(InterfaceLaw):
    """Hard unilateral contact with Coulomb friction: an element sticks, slides or opens.

    ``friction``: coefficient, 0 or more; ``math.inf`` for a base that opens but never slides. With 3 or more, steps in
    plan may have several solutions: compare the run with one of the mirror image. ``tensile_strength`` (Pa; 0 by
    default) acts on an element until it first opens. ``closed_below`` (m): if given, the contact conditions of an
    element whose gap is at most this length act on the change of the gap (Moreau's rule); otherwise they act on the
    gap.
    """

    def __new__(
        cls,
        friction: float,
        *,
        tensile_strength: float = 0.0,
        closed_below: float | None = None,
    ) -> Self: ...
    @property
    def friction(self) -> float:
        """Friction coefficient, a number."""

@final
class Cohesive(InterfaceLaw):
    """A bond that breaks permanently, and friction afterwards: ``tension`` and ``cohesion`` are its strengths (Pa) against
    opening and shear, ``friction`` the friction coefficient after it is broken.
    """

    def __new__(cls, tension: float, cohesion: float, friction: float) -> Self: ...

@final
class Yielding(InterfaceLaw):
    """Coulomb friction on soil that yields under its bearing pressure.

    ``bearing_pressure``: Pa. ``friction``: coefficient. Only friction bounds the shear traction, not an undrained strength.
    """

    def __new__(cls, bearing_pressure: float, friction: float) -> Self: ...

@final
class CyclicYielding(InterfaceLaw):
    """Coulomb friction on soil that settles in every cycle of load.

    ``friction``: coefficient. ``bearing_pressure``: largest pressure of the soil, Pa. Only friction bounds the shear
    traction, not an undrained strength.

    Under virgin load half of the bearing pressure acts at the ``reference_settlement`` (m; 0 or more).
    ``elastic_range``: increase of pressure without yielding, relative to the bearing pressure, above 0 and at most 1; 1
    unless given, for soil that yields again only above its largest previous pressure. ``depth_gradient``: growth of the
    bearing pressure with the settlement, Pa/m; 0 unless given (`ShallowFooting.pressure_growth`). State variables of an
    element: settlement (m), and pressure above which it yields (Pa).
    """

    def __new__(
        cls,
        bearing_pressure: float,
        reference_settlement: float,
        friction: float,
        *,
        elastic_range: float = 1.0,
        depth_gradient: float = 0.0,
    ) -> Self: ...
    def virgin_settlement(self, pressure: float) -> float:
        """Settlement (m) of soil without earlier load under a ``pressure`` (Pa), without the settlement of the elastic
        ground.
        """

@final
class EarthPressure(InterfaceLaw):
    """Coulomb friction between a wall and soil that yields.

    ``friction``: coefficient. The soil yields at its ``active`` pressure (Pa) towards a wall that moves away, at its
    ``passive`` pressure (Pa) under a wall that moves into it.

    With an ``active`` pressure of 0 the soil is stable by its cohesion, and a gap opens at the wall.
    `TrenchGround.interfaces` creates these laws from the strength of the soil.
    """

    def __new__(cls, active: float, passive: float, friction: float) -> Self: ...
    @property
    def pressures(self) -> list[float]:
        """Active and passive pressure, Pa."""

@final
class ThinLayer(InterfaceLaw):
    """Thin elastic layer between base and ground (Patel and Spyrakos).

    ``soil``: `Soil` of the layer. ``neighbour_height``: height of the finite elements beside the layer, m.
    ``friction``: coefficient. ``thickness_ratio``: ratio of the thickness of the layer to this height; 0.1 unless
    given. ``debonded_ratio``: fraction of the stiffness that remains while the layer is open, 0 to 1; 0.001 unless
    given. ``slip_stiffness_ratio``: fraction of the shear stiffness that resists slip in addition to friction, 0 to 1;
    0 unless given. ``friction_limit``: pressure in the friction limit, "total" (of this step; the default), "lagged"
    (of the step before), "static" or "dynamic" (the magnitude of the change since the static state). ``slip_sense``:
    quantity that decides the sense of slip, "inelastic" (the slip without its elastic part; the default), "velocity"
    (the rate of slip in this step) or "last_velocity" (in the step before).
    """

    def __new__(
        cls,
        soil: Soil,
        neighbour_height: float,
        friction: float,
        *,
        thickness_ratio: float | None = None,
        debonded_ratio: float | None = None,
        slip_stiffness_ratio: float | None = None,
        friction_limit: _FrictionLimit | None = None,
        slip_sense: _SlipSense | None = None,
    ) -> Self: ...
    @staticmethod
    def from_stiffness(
        normal: float,
        shear: float,
        friction: float,
        *,
        debonded_ratio: float | None = None,
        slip_stiffness_ratio: float | None = None,
        friction_limit: _FrictionLimit | None = None,
        slip_sense: _SlipSense | None = None,
    ) -> ThinLayer:
        """Layer of given ``normal`` and ``shear`` stiffness (Pa/m); ``friction``, ``debonded_ratio``,
        ``slip_stiffness_ratio``, ``friction_limit`` and ``slip_sense`` are as in the class; the last four have its
        defaults unless given.
        """
    @property
    def stiffness(self) -> list[float]:
        """Normal and shear stiffness, Pa/m."""

@final
class VariableFriction(InterfaceLaw):
    """Coulomb friction whose coefficient is returned by a Python function.

    ``coefficient(start)`` returns a number for a `PreviousContact`. An exception of the function ends the run, which
    raises it. ``tensile_strength`` (Pa; 0 by default) acts on an element until it first opens.
    """

    def __new__(
        cls,
        coefficient: Callable[[PreviousContact], float],
        *,
        tensile_strength: float = 0.0,
    ) -> Self: ...

@final
class Joint:
    """Contact between two lines of nodes of a structure in the plane: a joint in a wall, a column under a cap, towers side
    by side. `between` creates it, and `Simulation` takes it in ``joints``.

    The upper side presses on the lower side as a base presses on the ground: with the same laws, modes and results, in
    the same search. A part of the structure that touches no ground may stand on another part by joints
    (``above`` of `StructureGroup`); it then moves with the ground under that part.

    Tractions act between the means of both sides over an element: a rigid body on n equal elements rocks about the middles
    of the outer elements, at 1 − 1/n of its half width. Displacements are small: bodies stay opposite their elements, and
    the weight of a body that tilts overturns it only with P–Δ (``p_delta`` and ``carried_weights`` of `RigidBlock`).
    Impacts of hard contact follow from the time scheme: ``TimeScheme.theta(1.0)`` makes them inelastic, bodies bounce with
    ``TimeScheme.midpoint()``.
    """

    @staticmethod
    def between(
        upper: BaseNode | Sequence[BaseNode],
        lower: BaseNode | Sequence[BaseNode],
        count: int,
        *,
        law: _Interface | Sequence[_Interface] | None = None,
        gap: float = 0.0,
    ) -> Joint:
        """Joint between the lines of nodes ``upper`` and ``lower``, lists of two or more `BaseNode`, with ``count`` equal
        contact elements over the length that both lines share.

        The nodes have their places and displacements in the structure of the simulation: ``contact_nodes`` of `RigidBlock`
        and `FemModel` make them, ``contact_nodes`` of `StructureGroup` converts those of a member. Both lines are straight and parallel,
        listed in the same sense; the lower side lies on the right-hand side of that sense: of a horizontal joint listed from
        left to right it is the side below, of a vertical joint listed upwards the side on the right. Positive slip is that
        of the upper side in the sense of the list.

        ``law``: an `InterfaceLaw` or an object with the methods of `UserLaw`, one for all elements or a list of one for
        each; `Bonded` unless given. ``gap`` (m): gap of the unloaded structure, as of an expansion joint; 0 by default.
        It needs a law that opens.
        """
    @staticmethod
    def around_nodes(
        upper: BaseNode | Sequence[BaseNode],
        lower: BaseNode | Sequence[BaseNode],
        *,
        law: _Interface | Sequence[_Interface] | None = None,
        gap: float = 0.0,
    ) -> Joint:
        """Joint between the lines of nodes ``upper`` and ``lower``, lists of `BaseNode`, with a contact element around each node
        of the lower side: for a lower side whose nodes are dense where pressures are large, as below the ends of a foundation on
        a box of soil (`NearField`). ``law`` and ``gap`` are as in `between`, and have its defaults unless given.
        """
    @property
    def upper(self) -> list[BaseNode]:
        """Nodes of the upper side: list of `BaseNode`."""
    @property
    def lower(self) -> list[BaseNode]:
        """Nodes of the lower side: list of `BaseNode`."""
    @property
    def count(self) -> int | None:
        """Number of equal contact elements; None for elements around the nodes of the lower side."""
    @property
    def law(self) -> Any:
        """The argument ``law``; None for a bonded joint."""
    @property
    def gap(self) -> float:
        """Gap of the unloaded structure, m."""

@disjoint_base
class Coherence:
    """Coherence Γ between the ground motions at two points: the correlation of their Fourier coefficients at a frequency,
    without the delay of a wave that passes. A `LucoWong`, an `AbrahamsonCoherence`, or a function (`CoherenceFn`).
    """

    def between(self, frequency: float, first: Sequence[float], second: Sequence[float]) -> float:
        """Coherence of the motions at the points ``first`` and ``second`` (x and y, m) at a ``frequency`` (Hz), a number."""

@final
class LucoWong(Coherence):
    """Coherence of Luco and Wong (1986): Γ = exp(−(α ω d/c)²) at a distance d, with ω = 2π times the frequency.

    ``alpha``: the parameter α, a number, 0 or more. ``shear_wave_speed``: speed c of shear waves in the soil, m/s.
    """

    def __new__(cls, alpha: float, shear_wave_speed: float) -> Self: ...

@final
class AbrahamsonCoherence(Coherence):
    """Plane-wave coherence of Abrahamson (2007), up to distances of 150 m.

    ``model``: "hard_rock_horizontal", "hard_rock_vertical", "soil_horizontal" (soil with shear waves of 180 to 290 m/s,
    from frequencies up to 20 Hz) or "soil_vertical". Its matrices can have negative eigenvalues: give ``clipped=True`` to
    `Incoherence`.
    """

    def __new__(cls, model: _AbrahamsonModel) -> Self: ...

@final
class CoherenceFn(Coherence):
    """A coherence that a function defines: give ``between`` or ``of_separation``.

    ``between``: a function ``(frequency, first, second)`` of a frequency (Hz) and two points (tuples of x and y, m).
    ``of_separation``: a function ``(frequency, separation)`` of the vector from one point to the other (tuple of x and y,
    m), with the same value for the opposite vector; few of its values are needed for cells on a lattice. The functions
    return the coherence, a number from −1 to 1. They are None unless given.
    """

    def __new__(
        cls,
        between: Callable[[float, tuple[float, float], tuple[float, float]], float] | None = None,
        *,
        of_separation: Callable[[float, tuple[float, float]], float] | None = None,
    ) -> Self: ...

@disjoint_base
class FreeField:
    """Motion of the ground's surface without the structure: a `Record`, a wave, or a function (`free_field`). Until t = 0
    the ground is at rest.
    """

    def displacement(self, x: float, time: float) -> list[float]:
        """Displacement (to the right, up), m, at ``x`` (m) and ``time`` (s)."""
    def displacement_at(self, x: float, y: float, time: float) -> list[float]:
        """Displacement (along x, along y, up), m, at the point ``x``, ``y`` (m) of a ground in plan and ``time`` (s)."""
    def velocity(self, x: float, time: float) -> list[float]:
        """Velocity (to the right, up), m/s, at ``x`` (m) and ``time`` (s)."""

@final
class Incoherence:
    """Incoherence of the ground motion under a base; `motion` makes an `IncoherentMotion` of records.

    ``coherence``: a `Coherence` of the motions at two points. ``vertical``: that of the vertical motion; the same unless
    given. ``apparent_velocity`` (m/s) and ``azimuth`` (rad, counter-clockwise from x as seen from above; 0 by default): of a
    wave that passes, which delays each element; all elements move at once unless given. ``reference``: the point
    (x and y, m) that moves as the records; the middle of the base unless given. ``bandwidth``: interval between frequencies
    with independent phases, Hz; 0.5 by default. ``seed``: number of the sample; 0 by default. The same seed gives the same
    motion on every machine. ``clipped``: whether negative eigenvalues of the coherence are replaced by zero instead of being
    errors; False by default.
    """

    def __new__(
        cls,
        coherence: Coherence,
        *,
        vertical: Coherence | None = None,
        apparent_velocity: float | None = None,
        azimuth: float = 0.0,
        reference: Sequence[float] | None = None,
        bandwidth: float = 0.5,
        seed: int = 0,
        clipped: bool = False,
    ) -> Self: ...
    def motion(
        self,
        ground: Ground,
        x: Record | None = None,
        y: Record | None = None,
        up: Record | None = None,
    ) -> IncoherentMotion:
        """The `IncoherentMotion` of the contact elements of a ``ground`` on the surface, with the records ``x`` (to the right),
        ``y`` (away, in plan) and ``up`` (each a `Record`) at the reference point; a component is zero unless given.

        The records must end at rest and begin with quiet time, 3 s or more: `Record.with_baseline` and `Record.padded`.
        """

@final
class IncoherentMotion(FreeField):
    """Free field that differs from element to element at random, with a given coherence: `Incoherence.motion`.

    It is defined at the centres of the elements of one ground, and NaN elsewhere.
    """

    @property
    def min_eigenvalue(self) -> float:
        """Most negative eigenvalue of the coherence that was replaced by zero, a number; zero if none was."""

@final
class Record(FreeField):
    """Ground acceleration at equal time steps, linear between samples; velocity and displacement are
    its exact integrals from rest.

    ``time_step`` in s, ``acceleration`` an array of shape (samples,), at least two, in ``unit``: "m/s²" (the default),
    "mm/s²", "g", "gal", "ft/s²" or "in/s²". As the motion of a simulation it is horizontal and the same everywhere.
    """

    def __new__(
        cls,
        time_step: float,
        acceleration: ArrayLike,
        *,
        unit: _AccelerationUnit = "m/s²",
    ) -> Self: ...
    @property
    def time_step(self) -> float:
        """Time step, s."""
    @property
    def duration(self) -> float:
        """Time of the last sample, s."""
    @property
    def times(self) -> NDArray[np.float64]:
        """Times of the samples: array of shape (samples,), s."""
    @property
    def accelerations(self) -> NDArray[np.float64]:
        """Acceleration at the samples: array of shape (samples,), m/s²."""
    @property
    def velocities(self) -> NDArray[np.float64]:
        """Velocity at the samples: array of shape (samples,), m/s."""
    @property
    def displacements(self) -> NDArray[np.float64]:
        """Displacement at the samples: array of shape (samples,), m."""
    @property
    def peak_acceleration(self) -> float:
        """Largest |acceleration|, m/s²."""
    @property
    def peak_velocity(self) -> float:
        """Largest |velocity|, m/s."""
    @property
    def peak_displacement(self) -> float:
        """Largest |displacement|, m."""
    @property
    def arias_intensity(self) -> float:
        """Arias intensity, m/s."""
    @staticmethod
    def read(
        path: str | os.PathLike[str],
        *,
        format: _RecordFormat = "columns",
        unit: _AccelerationUnit | None = None,
        time_step: float | None = None,
        columns: Sequence[int] | None = None,
        channel: int | None = None,
        header_lines: int | None = None,
        samples: int | None = None,
        layout: str | None = None,
    ) -> Record:
        """Reads a file at ``path``.

        ``format``: "columns" (the default: columns of text with the time, in s or as a time of day, and the
        acceleration), "along_lines" (several values on a line: SHAKE, OpenSees), "peer" (.AT2), "cosmos" (.V2, COSMOS
        and CSMIP), "k_net" (K-NET and KiK-net), "k_net_csv", "esm" (ESM and ITACA), "afad", "slist" (ObsPy), "smc" or
        "geonet". ``unit``: unit of the acceleration, as for the class. It is needed for "columns" and "along_lines",
        and for files of "cosmos" and "slist" that do not name it; files of other formats have a fixed unit.

        For "columns", ``columns`` are the numbers of the columns of time and acceleration, counted from 1, (1, 2)
        unless given. If ``time_step`` (s) is given, the times are ignored, and the file must have one column unless
        ``columns`` is given. "along_lines" needs the ``time_step``; ``layout`` is the Fortran format of the lines, such
        as "8F9.6", none unless given. For both formats ``header_lines`` at the beginning are skipped, and it is an
        error if the number of samples is not ``samples``, if given.

        ``channel`` is the number of the component from 1, for formats with several components in a file ("cosmos",
        "k_net_csv", "afad", "geonet", "slist").
        """
    @staticmethod
    def read_all(
        path: str | os.PathLike[str],
        *,
        format: _RecordFormat = "columns",
        unit: _AccelerationUnit | None = None,
        time_step: float | None = None,
        header_lines: int | None = None,
    ) -> dict[str, Record]:
        """Reads all components of the file at ``path``, such as the three directions of a station: a
        dict from the name of each to its `Record`, in the order of the file.

        ``format``, ``unit``, ``time_step`` and ``header_lines`` are as for `read`, none unless given. Of a file of
        columns, all columns except the column of times are read.
        """
    def significant_times(self, start: float = 0.05, end: float = 0.95) -> list[float]:
        """The two times (s) at which the fractions ``start`` and ``end`` of the Arias intensity are reached,
        by default 0.05 and 0.95: between them is the significant duration.
        """
    def scaled(self, factor: float) -> Record:
        """Record with all samples multiplied by a ``factor``."""
    def scaled_to_peak(self, peak: float) -> Record:
        """Record scaled to a ``peak`` acceleration (m/s²); signs stay the same."""
    def resampled(self, time_step: float) -> Record:
        """Record with samples every ``time_step`` (s), interpolated linearly between the present samples."""
    def with_baseline(self, treatment: _Baseline, *, degree: int = 4) -> Record:
        """Record with a corrected baseline. ``treatment``: "remove_mean", "newmark_parabola", "velocity_polynomial",
        "displacement_polynomial" or "rest_to_rest"; polynomials have the ``degree``, 4 by default.
        """
    def high_pass(self, corner: float, *, order: int = 4) -> Record:
        """Record filtered at a ``corner`` frequency (Hz): a high-pass Butterworth filter of ``order`` (1 to 8; 4 by
        default), applied forwards and backwards, so that phases do not shift.

        Rest of 1.5 ``order / corner`` s is added before and after the record, 30 s each for a corner of 0.2 Hz, since
        the filter changes the motion there. Do not remove this rest: without it velocity and displacement do not return
        to zero.
        """
    def low_pass(self, corner: float, *, order: int = 4) -> Record:
        """Record filtered at a ``corner`` frequency (Hz): a low-pass Butterworth filter of ``order`` (1 to 8; 4 by
        default), applied forwards and backwards, so that phases do not shift; rest is added as by `high_pass`. Use it
        before a deconvolution (`SoilColumn.from_surface`).
        """
    def tapered(self, beginning: float, end: float) -> Record:
        """Record tapered over the durations ``beginning`` and ``end`` (s) at its two ends."""
    def padded(self, before: float, after: float) -> Record:
        """Record with rest of ``before`` and ``after`` (s) at its two ends."""
    def response_spectrum(self, periods: ArrayLike, damping: float = 0.05) -> Spectrum:
        """Elastic response `Spectrum` at ``periods`` (array of shape (m,), s) with the damping ratio
        ``damping`` (0.05 by default).
        """
    def __len__(self) -> int: ...
    def __getnewargs__(self) -> tuple[float, NDArray[np.float64]]: ...

@final
class Spectrum:
    """A response spectrum: arrays of shape (m,), one value per natural period."""

    @property
    def period(self) -> NDArray[np.float64]:
        """Natural periods: array of shape (m,), s."""
    @property
    def displacement(self) -> NDArray[np.float64]:
        """Largest displacements relative to the ground or floor: array of shape (m,), m."""
    @property
    def pseudo_velocity(self) -> NDArray[np.float64]:
        """Pseudo-velocities: array of shape (m,), m/s."""
    @property
    def pseudo_acceleration(self) -> NDArray[np.float64]:
        """Pseudo-accelerations: array of shape (m,), m/s²."""
    @property
    def acceleration(self) -> NDArray[np.float64]:
        """Largest total accelerations: array of shape (m,), m/s²."""
    @property
    def warnings(self) -> list[str]:
        """Texts of warnings of periods shorter than ten time steps of the record, where the spectrum is not exact."""
    def broadened(self, fraction: float = 0.15) -> Spectrum:
        """Spectrum with peaks that are broadened to both sides by the ``fraction`` of their frequency, 0.15 by default
        (U.S. NRC R.G. 1.122).
        """
    def __len__(self) -> int: ...
    def plot(
        self,
        axes: Axes | None = None,
        *,
        label: str | None = None,
        color: str | None = None,
        title: str | None = None,
    ) -> Axes:
        """Draws total and pseudo-accelerations over the period; returns the axes.

        ``axes``: those of matplotlib to draw into; unless given, axes of a new figure. For several spectra in the same axes:
        ``label``, a name before the names of the curves, and ``color`` of both. ``title`` stands above the picture; None for
        none.
        """
    def to_frame(self) -> DataFrame:
        """The spectrum as a pandas frame, indexed by the period (s)."""

@final
class TrenchMotion(FreeField):
    """Free field of a trench: vertical waves below a surface that moves as recorded; `travelling` is for other waves.

    ``ground``: the `TrenchGround`, without backfill; the simulation's ground must be this one. ``horizontal``: `Record`
    of the surface's motion to the right (shear waves). ``vertical``: `Record` of its motion up (pressure waves). A
    component is zero unless given. Motion at depth precedes the motion of the surface: begin the record with rest that
    lasts the travel time of the waves from the base to the surface (`Record.padded`).
    """

    def __new__(
        cls,
        ground: TrenchGround,
        horizontal: Record | None = None,
        vertical: Record | None = None,
    ) -> Self: ...
    @staticmethod
    def travelling(ground: TrenchGround, wave: FreeField) -> TrenchMotion:
        """The `TrenchMotion` of a ``wave`` around the trench of ``ground``: a field of a `PlaneWave` or of an
        `InclinedWave`, or a `travelling_wave`.

        The wave must belong to the profile of the ground and travel along x: the motion and the apparent velocity at
        the surface determine the field below. The motion before and after the record of the wave decays within half the
        length of the record.
        """

@final
class PlaneWave:
    """Plane wave below the surface of a half-plane, or Rayleigh wave.

    `field_from_horizontal` and `field_from_vertical` convert it to a motion.
    """

    @staticmethod
    def sv(soil: Soil, angle: float) -> PlaneWave:
        """SV wave from below in a half-plane of this ``soil`` at ``angle`` (rad) from the vertical, to the
        right if positive.
        """
    @staticmethod
    def sh(soil: Soil, angle: float) -> PlaneWave:
        """SH wave from below at ``angle`` (rad) from the vertical in this ``soil``, for a ground in plan: it moves the
        surface only perpendicular to its direction.
        """
    @staticmethod
    def p(soil: Soil, angle: float) -> PlaneWave:
        """P wave from below in a half-plane of this ``soil`` at ``angle`` (rad) from the vertical, to the
        right if positive.
        """
    @staticmethod
    def rayleigh(soil: Soil) -> PlaneWave:
        """Rayleigh wave to the right on a half-plane of this ``soil``."""
    def field_from_horizontal(self, record: Record, origin: float, *, azimuth: float = 0.0) -> FreeField:
        """The `FreeField` whose horizontal motion at ``origin`` (x, m) is the ``record``; ``azimuth`` (rad; 0 by default) is as in
        `travelling_wave`.
        """
    def field_from_vertical(self, record: Record, origin: float, *, azimuth: float = 0.0) -> FreeField:
        """The `FreeField` whose vertical motion (up) at ``origin`` (x, m) is the ``record``; ``azimuth`` (rad; 0 by default) is as in
        `travelling_wave`.
        """
    def field_from_across(self, record: Record, origin: float, *, azimuth: float = 0.0) -> FreeField:
        """The `FreeField` whose motion perpendicular to its direction at ``origin`` (x, m) is the ``record``, of an SH
        wave; ``azimuth`` (rad; 0 by default) is as in `travelling_wave`.
        """
    @property
    def apparent_velocity(self) -> float:
        """Apparent velocity along the surface, m/s."""
    def reversed(self) -> PlaneWave:
        """Wave with the same motion in the opposite direction."""

@final
class SoilColumn:
    """A soil ``profile`` (`SoilProfile`) as a column with vertical waves; ``wave``: "shear" (the default) or "pressure"."""

    def __new__(cls, profile: SoilProfile, wave: _Wave = "shear") -> Self: ...
    def transfer(
        self,
        frequencies: ArrayLike,
        *,
        control: _ControlPoint = "outcrop",
    ) -> NDArray[np.complex128]:
        """Ratio of the surface motion to the motion of the ``control`` point for e^(iωt): complex array of shape (m,) at
        ``frequencies`` (array of shape (m,), Hz). ``control``: "outcrop" (the default: the base without layers) or
        "within" (the base under them).
        """
    def to_surface(self, record: Record, *, control: _ControlPoint = "outcrop") -> Record:
        """The record of the surface, as long as the ``record`` of the ``control`` point, "outcrop" (the default) or
        "within". If the motion is cut off at the ends of the record, a `BasematWarning` states the cut-off part
        relative to the peak, if it is above 0.01 %; `Record.padded` avoids this.
        """
    def from_surface(self, record: Record, *, control: _ControlPoint = "outcrop") -> Record:
        """The record of the ``control`` point, "outcrop" (the default) or "within", from the ``record`` of the surface
        (deconvolution); it warns as `to_surface`, and also if most of the motion is noise that the deconvolution
        amplifies more than a hundredfold: filter the record with `Record.low_pass` before, typically at 15 to 25 Hz.
        """
    @staticmethod
    def surface_in_plan(
        profile: SoilProfile,
        x: Record | None = None,
        y: Record | None = None,
        up: Record | None = None,
        *,
        control: _ControlPoint = "outcrop",
    ) -> list[Record | None]:
        """Records of the surface, a list of those along x, along y and up, from records of the ``control`` point,
        "outcrop" (the default) or "within", of a ``profile`` (`SoilProfile`): ``x`` and ``y`` by shear waves, ``up`` by
        pressure waves; None for a record that is not given.
        """
    def equivalent_linear(
        self,
        record: Record,
        curves: StrainCurves | Sequence[StrainCurves],
        *,
        control: _ControlPoint = "outcrop",
        strain_ratio: float | None = None,
        tolerance: float | None = None,
        most_iterations: int | None = None,
        band: Sequence[float] | None = None,
        complex_modulus: Literal["real_part", "magnitude"] = "real_part",
    ) -> EquivalentLinear:
        """Response with strain-compatible properties, an `EquivalentLinear`, to the ``record`` of the ``control``
        point, "outcrop" (the default) or "within"; ``curves``: a list of `StrainCurves`, one per layer.

        ``strain_ratio``: ratio of the effective to the largest strain, often (M − 1)/10 for the magnitude M; 0.65
        unless given. ``tolerance``: relative tolerance of moduli and damping ratios; 1e-3 unless given.
        ``most_iterations``: largest number of iterations; 50 unless given. ``band``: frequencies (Hz) between which
        damping is constant; 0.1 to 30 Hz unless given. ``complex_modulus`` of the layers: "real_part", G(1 + 2iξ) (the
        default), or "magnitude", G(1 − 2ξ² + 2iξ√(1 − ξ²)) as in SHAKE91.
        """

@final
class InclinedWave:
    """A plane wave from the half-plane under a layered profile; `field` converts it to a motion."""

    @staticmethod
    def sv(profile: SoilProfile, angle: float) -> InclinedWave:
        """SV wave at ``angle`` (rad) from the vertical in the base of the ``profile``, to the right if positive."""
    @staticmethod
    def sh(profile: SoilProfile, angle: float) -> InclinedWave:
        """SH wave with a ``profile`` and an ``angle`` (rad) as for `sv`, for a ground in plan: its motion is horizontal
        and perpendicular to its direction.
        """
    @staticmethod
    def p(profile: SoilProfile, angle: float) -> InclinedWave:
        """P wave at ``angle`` (rad) from the vertical in the base of the ``profile``, to the right if positive."""
    @property
    def apparent_velocity(self) -> float:
        """Apparent velocity along the surface, m/s."""
    def field(
        self,
        record: Record,
        origin: float,
        *,
        control: _InclinedControl = "outcrop_horizontal",
        azimuth: float = 0.0,
    ) -> FreeField:
        """The `FreeField` of the surface for the ``record`` of the ``control`` point below ``origin`` (x, m), the edge of
        the base that the wave reaches first. ``control``: "outcrop_horizontal" (the default), "outcrop_vertical" (base
        without layers) or "incident" (incident wave alone). ``azimuth`` (rad; 0 by default) is as in `travelling_wave`.
        """

@final
class Probe:
    """A quantity recorded at every step: a weighted sum of displacements, velocities or accelerations.

    ``name``: name of its time series. ``row``: a `DofCombination` or its ``terms``. ``unit``: its label in tables;
    unless given, the unit of the quantity.

    Displacements are changes against the static state, relative to the translation of the free field;
    `absolute_displacement` includes it. Velocities and accelerations are total. The names of the probes of a simulation
    differ from each other and from the names of other time series of a run.
    """

    @staticmethod
    def displacement(name: str, row: _RowLike, *, unit: str | None = None) -> Probe:
        """Displacement (m, or rad of a rotation) of the ``row`` relative to the free field, as the time
        series ``name``; ``unit``: its label, "m" unless given.
        """
    @staticmethod
    def absolute_displacement(name: str, row: _RowLike, *, unit: str | None = None) -> Probe:
        """Displacement (m) of the ``row`` including the translation of the free field, as the time series ``name``;
        ``unit``: its label, "m" unless given.
        """
    @staticmethod
    def velocity(name: str, row: _RowLike, *, unit: str | None = None) -> Probe:
        """Total velocity of the ``row``, m/s, as the time series ``name``; ``unit``: its label, "m/s" unless
        given.
        """
    @staticmethod
    def acceleration(name: str, row: _RowLike, *, unit: str | None = None) -> Probe:
        """Total acceleration of the ``row``, m/s², as the time series ``name``; ``unit``: its label, "m/s²"
        unless given.
        """
    @staticmethod
    def section(name: str, section: SectionRows, *, unit: str | None = None) -> Probe:
        """Resultant of a ``section`` (`SectionRows`), a force (N/m, in plan N) or a moment (N·m/m, in plan N·m), as the
        time series ``name``; ``unit``: its label; unless given, the section's.
        """
    @property
    def name(self) -> str:
        """Name of the probe and of its time series."""
    @property
    def unit(self) -> str:
        """Label of its unit. It converts nothing: values are sums of SI values times the weights."""
    @property
    def rows(self) -> list[DofCombination]:
        """Three `DofCombination`: of displacements, of velocities and of accelerations."""

@final
class DampingLaw:
    """Damping of a soil: its complex shear modulus over frequency."""

    @staticmethod
    def elastic() -> DampingLaw:
        """No damping."""
    @staticmethod
    def constant_q(ratio: float, band: Sequence[float] = (0.1, 30.0), reference: float = 1.0) -> DampingLaw:
        """Generalised Maxwell body with the damping ``ratio`` (0.05: 5 %) over a ``band`` (lowest and highest frequency,
        Hz; 0.1 to 30 by default) and the soil's modulus at the frequency ``reference`` (Hz; 1 by default): the usual
        choice in the time domain.
        """
    @staticmethod
    def maxwell(long_term: float, ratios: ArrayLike, rates: ArrayLike) -> DampingLaw:
        """Generalised Maxwell body of m mechanisms. ``long_term``: ratio of its long-term modulus to the modulus of the
        soil. ``ratios``: ratios of the moduli of the mechanisms to the modulus of the soil (array of shape (m,)).
        ``rates``: their relaxation rates (array of shape (m,), 1/s).
        """
    @staticmethod
    def kelvin_voigt(ratio: float, frequency: float) -> DampingLaw:
        """Kelvin–Voigt body with the damping ``ratio`` at ``frequency`` (Hz)."""
    @staticmethod
    def kjartansson(ratio: float, reference: float = 1.0) -> DampingLaw:
        """Exactly constant damping ``ratio`` (Kjartansson 1979) with the soil's modulus at the frequency ``reference``
        (Hz; 1 by default).
        """
    @staticmethod
    def hysteretic(ratio: float) -> DampingLaw:
        """Damping ``ratio`` that is the same at all frequencies, as usual in the frequency domain. It is not causal: for
        impedances only.
        """

@final
class SoilLayer:
    """A horizontal soil layer with its ``soil`` (`Soil`), its ``thickness`` (m), its ``damping`` (`DampingLaw`; none
    unless given). It is linear: soil that yields is a material of a `Mesh`.
    """

    def __new__(cls, soil: Soil, thickness: float, damping: DampingLaw | None = None) -> Self: ...
    @property
    def soil(self) -> Soil:
        """`Soil` of the layer."""
    @property
    def thickness(self) -> float:
        """Thickness of the layer, m."""

@final
class SoilProfile:
    """Horizontal soil layers on a half-plane or on rigid bedrock.

    ``layers``: list of `SoilLayer` from the surface down. They lie on a half-plane of the soil ``bedrock``, or on rigid
    bedrock if ``bedrock`` is not given. ``bedrock_damping``: `DampingLaw` of the bedrock; none unless given. Printed,
    it is a table.
    """

    def __new__(
        cls,
        layers: SoilLayer | Sequence[SoilLayer],
        bedrock: Soil | None = None,
        *,
        bedrock_damping: DampingLaw | None = None,
    ) -> Self: ...
    @property
    def layers(self) -> list[SoilLayer]:
        """The layers from the surface down: list of `SoilLayer`."""
    @property
    def bedrock(self) -> Soil | None:
        """The `Soil` of the half-plane under the layers; None on rigid bedrock."""
    def stress_at_rest(self, gravity: float, ratio: float | None = None) -> StressAtRest:
        """`StressAtRest` of these soils, for finite elements that begin with it.

        ``gravity``: m/s². ``ratio``: K₀ of all soils, the horizontal over the vertical pressure; ν/(1 − ν) of each soil, as
        for a trench, unless given. The last layer on rigid bedrock extends to any depth.
        """
    @property
    def depth(self) -> float:
        """Total thickness of the layers, m."""
    @property
    def first_frequency(self) -> float | None:
        """First natural frequency of the layers, Hz; None without layers."""
    @property
    def travel_time(self) -> float:
        """Travel time of a shear wave through all layers, s."""
    def _repr_html_(self) -> str: ...
    def plot(
        self,
        axes: Axes | None = None,
        *,
        label: str | None = None,
        color: str | None = None,
        title: str | None = None,
    ) -> Axes:
        """Draws the speed of shear waves over the depth; returns the axes.

        ``axes``: those of matplotlib to draw into; unless given, axes of a new figure. For several profiles in the same axes:
        ``label``, a name of the curve, and its ``color``. ``title`` stands above the picture; None for none.
        """

@final
class Refinement:
    """Error against run time at six settings: what `refine` returns. Printed, it is a table."""

    @property
    def results(self) -> list[NDArray[np.float64]]:
        """Results of the settings, in the units of the scene: list of 6 arrays of shape (results,)."""
    @property
    def time_steps(self) -> NDArray[np.float64]:
        """Time steps of the settings: array of shape (6,), s."""
    @property
    def errors(self) -> NDArray[np.float64]:
        """Estimated errors of the settings, relative to the magnitude of the results: array of shape (6,)."""
    @property
    def wall_times(self) -> NDArray[np.float64]:
        """Wall times of the settings: array of shape (6,), s."""
    @property
    def elements(self) -> list[int]:
        """Numbers of elements of the settings: list of 6."""
    @property
    def extrapolated(self) -> NDArray[np.float64]:
        """Results extrapolated to infinitely many elements and steps: array of shape (results,), in the
        units of the scene.
        """
    @property
    def mesh_order(self) -> float:
        """Observed order of convergence in the element length; NaN if the results do not depend on it."""
    @property
    def step_order(self) -> float:
        """Observed order of convergence in the time step; NaN if the results do not depend on it."""
    @property
    def mismatch(self) -> float:
        """Difference between the results of the last setting and the results predicted from the other errors, relative to
        the magnitude of the results.
        """
    @property
    def is_regular(self) -> bool:
        """Whether the estimate can be trusted: the orders are regular, and the error of the coarsest setting is above the
        mismatch.
        """

@final
class Refinements:
    """Error against run time of several peaks: what `refine` returns for a scene that returns a dict. Printed, it is
    one table.
    """

    @property
    def names(self) -> list[str]:
        """Names of the peaks, in the order of the scene."""
    def __getitem__(self, key: str, /) -> Refinement: ...

@final
class PeakTwins:
    """Value of a peak in a run and in its twins."""

    @property
    def name(self) -> str:
        """Name of the peak."""
    @property
    def value(self) -> float:
        """Value of the run, in the unit of the peak."""
    @property
    def shorter_step(self) -> float:
        """Value with a time step shorter by 1 %, in the unit of the peak."""
    @property
    def three_quarters(self) -> float:
        """Value on three quarters of the elements, rounded up, in the unit of the peak."""
    @property
    def half(self) -> float:
        """Value on half the elements, rounded up, in the unit of the peak."""
    @property
    def spread(self) -> float:
        """Largest difference between a twin and the run, in the unit of the peak."""
    @property
    def digits(self) -> int:
        """Number of reliable significant digits, at most six: half a unit of the last digit is the spread or more."""
    def __eq__(self, value: object, /) -> bool: ...

@final
class Sensitivity:
    """Peaks of a run and of its twins: what `sensitivity` returns. Printed, it is a table."""

    @property
    def peaks(self) -> list[PeakTwins]:
        """The peaks, in the order of the scene: list of `PeakTwins`."""
    def __getitem__(self, key: str, /) -> PeakTwins: ...

@final
class EnergyBalance:
    """Energies since the start, J, in the plane J per metre of thickness:
    ``kinetic + strain + hysteresis + damping + algorithmic + midstep_remainder + soil + contact + interface
    + static_contact = input``.
    """

    @property
    def kinetic(self) -> float:
        """Kinetic energy ½ v·M v, J."""
    @property
    def strain(self) -> float:
        """Elastic energy of the structure, J."""
    @property
    def hysteresis(self) -> float:
        """Energy dissipated in hysteretic parts of the structure, J."""
    @property
    def damping(self) -> float:
        """Work of the dashpots, J."""
    @property
    def algorithmic(self) -> float:
        """Energy that the time scheme removes, J; negative if it adds energy."""
    @property
    def midstep_remainder(self) -> float:
        """Work of yielding parts inside the steps that is neither stored nor dissipated, J."""
    @property
    def soil(self) -> float:
        """Work done on the soil, J; the soil radiates part of it and stores the rest."""
    @property
    def contact(self) -> float:
        """Energy lost by friction and impact, J."""
    @property
    def interface(self) -> float:
        """Elastic energy of compliant interfaces, J."""
    @property
    def static_contact(self) -> float:
        """Potential of the static tractions against gaps and slips, J."""
    @property
    def input(self) -> float:
        """Work of loads and free field, and the energy of an initial motion, J."""
    @property
    def relative_input(self) -> float:
        """Relative input energy (Uang and Bertero 1990), J."""
    @property
    def soil_error_bound(self) -> float:
        """Bound of the error of `soil` that the approximation of the history causes, J."""
    @property
    def largest(self) -> float:
        """Largest energy so far, to which `residual` is relative, J."""
    @property
    def residual(self) -> float:
        """Difference between the two sides of the balance, relative to the largest energy so far."""
    def to_dict(self) -> dict[str, float]:
        """All terms by their names: dict of numbers, J, in the plane J/m."""
    def _repr_html_(self) -> str: ...

@final
class SystemMode:
    """Vibration mode on a fixed base and on the ground (ASCE 7, chapter 19)."""

    @property
    def axis(self) -> str | None:
        """Axis along which the mode has the largest participating mass, "x" or "y" in plan; None in the plane."""
    @property
    def fixed_period(self) -> float:
        """Period T on a fixed base, s."""
    @property
    def fixed_damping(self) -> float:
        """Damping ratio β on a fixed base."""
    @property
    def period(self) -> float:
        """Period T̃ of the soil–structure system, s."""
    @property
    def damping(self) -> float:
        """Damping ratio β₀ of the soil–structure system."""
    @property
    def period_ratio(self) -> float:
        """Period lengthening T̃/T, a ratio."""
    @property
    def foundation_damping(self) -> float:
        """Foundation damping ratio β_f = β₀ − β/(T̃/T)²: radiation and the damping of the soil."""
    def __eq__(self, value: object, /) -> bool: ...

@final
class Interaction:
    """A scene on its ground and on a fixed base: what `Simulation.interaction` returns. Printed, it is a table for a
    report.
    """

    @property
    def on_ground(self) -> Run:
        """The `Run` on the ground, without time series."""
    @property
    def on_fixed_base(self) -> Run:
        """The `Run` on the fixed base, without time series."""
    @property
    def modes(self) -> list[SystemMode]:
        """The mode with the largest participating mass along x, in plan also the mode for y: list of `SystemMode`; empty
        for a structure that is rigid.
        """
    @property
    def probe_ratios(self) -> dict[str, float]:
        """Ratios of the largest magnitudes of the probes on the ground to those on the fixed base: dict of numbers by the
        names of the probes.
        """
    def ratio(self, name: str) -> float:
        """Ratio of the largest magnitudes of the scalar ``name``, such as "base_shear", on the ground and on the fixed base;
        NaN where both are zero.
        """
    def _repr_html_(self) -> str: ...

@final
class JointResults:
    """Results of one joint in a run: time series, snapshots and envelopes. `Run.joints` lists them.

    ``run.joints[0]["mean_slip"]`` is the time series of a scalar at ``run.time``. Forces act from the upper side on the
    lower side, per metre of thickness.
    """

    @property
    def series(self) -> dict[str, NDArray[np.float64]]:
        """All time series: dict of arrays of shape (steps + 1,): "time" (s), "normal_force" (N/m, positive in compression),
        "shear_force" (N/m, on the lower side, positive in the sense of the joint's nodes), "moment" (N·m/m, of the
        pressures about the middle, positive if the pressure is larger before the middle), "open_fraction" (a ratio of
        lengths), "mean_slip", "largest_gap" (m) and "contact_energy" (J/m, lost by friction and impact).
        """
    @property
    def units(self) -> dict[str, str]:
        """SI units of the time series: dict of texts by their names, "" for ratios."""
    @property
    def elements(self) -> NDArray[np.float64]:
        """Places of the contact elements on the upper side at rest: array of shape (elements, 4), x at the first and at the
        second end, lower and upper height above the surface, m.
        """
    @property
    def contact(self) -> dict[str, NDArray[Any]]:
        """Snapshots of the joint (``contact_every`` of `Simulation.run`): dict of "time" (frames,), s, and "gap", "slip"
        (m), "pressure", "shear" (Pa), "mode" (numbers into `basemat.MODES`), each of shape (frames, elements).
        """
    @property
    def envelope(self) -> dict[str, NDArray[np.float64]]:
        """Envelopes of the elements: dict of arrays of shape (elements,): "left", "right", "bottom", "top", "gap", "slip"
        (m), "static_pressure", "lowest_pressure", "highest_pressure", "shear" (Pa), "open" (s); "gap_time",
        "lowest_pressure_time" and so on are the times of extremes (s).
        """
    def __getitem__(self, key: str, /) -> NDArray[np.float64]: ...
    def contact_frame(self) -> DataFrame:
        """Snapshots of the joint as a tidy pandas frame: a row per frame and element.

        Columns: "time" (s), "element", "x" and "z", the middle of the element on the upper side at rest (m), "gap", "slip"
        (m), "pressure", "shear" (Pa), "mode".
        """
    def envelope_frame(self) -> DataFrame:
        """`JointResults.envelope` as a pandas frame: a row per element."""
    def to_frame(self) -> DataFrame:
        """All time series of the joint as a pandas frame, indexed by the time (s)."""

@final
class Peak:
    """A value of a run with its time; ``float()`` returns the value."""

    @property
    def value(self) -> float:
        """The value, in the quantity's unit, with its sign."""
    @property
    def time(self) -> float:
        """Time of the value, s."""
    def __float__(self) -> float: ...
    def __eq__(self, value: object, /) -> bool: ...

@final
class Extremes:
    """Smallest and largest value of a quantity over a run."""

    @property
    def lowest(self) -> Peak:
        """The smallest value, a `Peak` in the quantity's unit."""
    @property
    def highest(self) -> Peak:
        """The largest value, a `Peak` in the quantity's unit."""
    @property
    def largest(self) -> Peak:
        """The one of `lowest` and `highest` that is further from zero, with its sign: a `Peak` in the quantity's unit."""
    @property
    def magnitude(self) -> float:
        """Magnitude of `largest`, in the quantity's unit."""
    def __eq__(self, value: object, /) -> bool: ...

@final
class PushOver:
    """Load against displacement of a static push-over: what `Simulation.push_over_by_displacement` returns.

    Arrays have one value for each state of the path. The first is the state under weight and loads, without the load pattern.
    """

    @property
    def load_factor(self) -> NDArray[np.float64]:
        """Factors of the load pattern: array of shape (states,), the force N/m (in plan N) of a pattern of weight 1."""
    @property
    def displacement(self) -> NDArray[np.float64]:
        """Displacements of the control, relative to the first state: array of shape (states,), m or rad."""
    @property
    def base_rotation(self) -> NDArray[np.float64]:
        """Rotations of the base, relative to the first state, counter-clockwise, in plan about the axis along y by the right-hand
        rule: array of shape (states,), rad. With several foundations the largest rotation.
        """
    @property
    def rotation_across(self) -> NDArray[np.float64]:
        """In plan rotations of the base about the axis along x by the right-hand rule, zero in the plane: array of shape
        (states,), rad.
        """
    @property
    def uplifted_fraction(self) -> NDArray[np.float64]:
        """Areas of open elements over the area of the base: array of shape (states,), each a ratio."""
    @property
    def sliding_fraction(self) -> NDArray[np.float64]:
        """Areas of elements that slide against friction over the area of the base: array of shape (states,), each a ratio."""
    @property
    def base_shear(self) -> NDArray[np.float64]:
        """Horizontal forces on the soil along x: array of shape (states,), N/m, in plan N."""
    @property
    def base_moment(self) -> NDArray[np.float64]:
        """Moments on the soil, with the signs of `State.base_moment`: array of shape (states,), N·m/m, in plan N·m."""
    @property
    def cause(self) -> str | None:
        """Text of the error that ended the curve before the last displacement; None if it has all of them."""
    @property
    def in_plan(self) -> bool:
        """Whether the ground is in plan: forces and moments are then those of the whole base."""
    def __len__(self) -> int: ...
    def plot(
        self,
        axes: Axes | None = None,
        *,
        label: str | None = None,
        color: str | None = None,
        title: str | None = None,
    ) -> Axes:
        """Draws the load over the displacement, with a mark where the foundation begins to lift off; returns the axes.

        The load factor is in thousands: kN/m, or in plan kN, for a pattern of weight 1. ``axes``: those of matplotlib to draw into;
        unless given, axes of a new figure. For several curves in the same axes: ``label``, a name of the curve, and its
        ``color``. ``title`` stands above the picture; None for none.
        """
    def to_frame(self) -> DataFrame:
        """The states as a pandas frame: a row per state, with the arrays of `PushOver` as columns."""

@disjoint_base
class Summary:
    """The whole base or one foundation over a run: largest values with their times, uplift and sliding.

    Forces act from the structure on the soil, per metre of thickness in the plane, of the whole body in plan (N and
    N·m).
    """

    @property
    def ends(self) -> list[float]:
        """x of the foundation's two ends, m."""
    @property
    def depth(self) -> list[float]:
        """In plan: y of its front and its back, m; zeros in the plane."""
    @property
    def static_normal_force(self) -> float:
        """Total pressure at the start, N/m."""
    @property
    def base_shear(self) -> Extremes:
        """Horizontal force on the soil, positive to the right, N/m: its `Extremes`."""
    @property
    def base_moment(self) -> Extremes:
        """Moment on the soil, counter-clockwise, N·m/m, of a foundation about its middle; in plan about y by the right-hand rule: its `Extremes`."""
    @property
    def normal_force(self) -> Extremes:
        """Total pressure on the soil, N/m: its `Extremes`."""
    @property
    def base_rotation(self) -> Extremes:
        """Rotation, counter-clockwise, rad, in plan about y by the right-hand rule: its `Extremes`."""
    @property
    def residual_rotation(self) -> float:
        """Rotation at the end, rad, in plan about y."""
    @property
    def residual_rotation_across(self) -> float:
        """In plan: rotation about x at the end, rad."""
    @property
    def settlement(self) -> Extremes:
        """Settlement of the centre since the static state, positive downwards, m; for several foundations the largest
        settlement: its `Extremes`.
        """
    @property
    def residual_settlement(self) -> float:
        """Settlement at the end, m."""
    @property
    def rocking_work(self) -> Extremes:
        """Work of the moment on the soil, ∫M dθ, J/m, in plan about y: its `Extremes`."""
    @property
    def uplifted_fraction(self) -> Peak:
        """Largest ratio of the open length to the length, in plan of the open area to the area: its `Peak`."""
    @property
    def uplift_duration(self) -> float:
        """Duration of uplift, s."""
    @property
    def mean_slip(self) -> Extremes:
        """Slip averaged over the foundation, m: its `Extremes`."""
    @property
    def residual_slip(self) -> float:
        """Slip averaged over the foundation at the end, m."""
    @property
    def residual_slip_across(self) -> float:
        """In plan: slip along y averaged over the foundation at the end, m."""
    @property
    def largest_slip(self) -> Peak:
        """Largest slip of any element, m: its `Peak`."""
    @property
    def slip_events(self) -> list[tuple[float, float, float]]:
        """Slip events: list of tuples (start in s, end in s, slip in m)."""
    @property
    def slip_path(self) -> float:
        """Sliding distance: sum of the |slip| increments over time, m."""
    @property
    def least_sliding_safety(self) -> Peak | None:
        """Lowest factor of safety against sliding, a `Peak`; None without a friction coefficient."""
    @property
    def least_overturning_safety(self) -> Peak:
        """Lowest factor of safety against overturning, a `Peak`; in plan the lower of "overturning_safety", over the left
        or the right edge, and "overturning_safety_across", over the front or the back edge. Pressure acts in the middle
        of elements: a base of few elements therefore tips about its edge at a factor above 1. The report of a run
        states this factor.
        """
    def extremes(self, quantity: _Quantity) -> Extremes:
        """The `Extremes` of a ``quantity``, in its unit: the name of a scalar time series such as
        "base_shear" or "free_field_horizontal", in plan also "shear_across", "torque", "uplifted_area" and so on.
        """

@final
class Run(Summary):
    """Results of a run: `Summary` of the whole base, energies and time series.

    It also has envelopes and warnings.

    ``run["base_shear"]`` is the time series of a scalar or a probe at ``run.time``, ``list(run.series)`` has all names;
    printed, a run is a page for a report.
    """

    @property
    def joints(self) -> list[JointResults]:
        """Each joint separately: list of `JointResults`, in the order of ``joints`` of the simulation."""
    def foundation_series(self, foundation: int) -> dict[str, NDArray[np.float64]]:
        """Time series of the scalars of a ``foundation`` (from 0): dict of arrays of shape (steps + 1,), "time" first.
        Moments are about the middle of the foundation. Several foundations need ``foundations=True`` of
        `Simulation.run`.
        """
    def rocking(self, foundation: int = 0, *, across: bool = False) -> dict[str, NDArray[np.float64]]:
        """Rocking of a ``foundation`` (0, the first, by default), counter-clockwise, in plan about y or with ``across``
        about x: dict of arrays of shape (steps + 1,): "time" (s), "rotation" (rad), "moment" on the soil about its
        middle (N·m/m, in plan N·m), "settlement" (m, positive downwards) and "work" of the moment on the soil (∫M dθ,
        J/m, in plan J).
        """
    def equivalent_damping(
        self,
        start: float,
        end: float,
        foundation: int = 0,
        *,
        across: bool = False,
    ) -> float:
        """Equivalent viscous damping ratio E/(2π M θ) of the one cycle of rocking between the times ``start`` and ``end`` (s).

        E is the work of the moment, M and θ are half the ranges of moment and rotation (Gajan and Kutter 2008). An
        `InputError` is raised if the steps are not one closed cycle. ``foundation`` and ``across`` as for `rocking`.
        """
    @property
    def steps(self) -> int:
        """Number of steps made."""
    @property
    def in_plan(self) -> bool:
        """Whether the ground was in plan: forces are then those of the whole body, in N instead of N/m."""
    @property
    def start(self) -> float:
        """Time at the beginning, s."""
    @property
    def end(self) -> float:
        """Time at the end, s."""
    @property
    def time_step(self) -> float:
        """Time step, s."""
    @property
    def ground_motion(self) -> dict[str, float | None]:
        """The ground motion: dict of "peak" (largest component of the acceleration, m/s²), "duration" and "time_step" of
        its record (s; None without one) and "passed", the fraction of the intensity of the record up to the end of the
        run.
        """
    @property
    def is_overturned(self) -> bool:
        """Whether the run ended because a base turned beyond the ``rotation_limit`` of the `Simulation`."""
    @property
    def _ground_motion(self) -> str:
        """The ground motion as a text, as in the report of the run."""
    @property
    def time(self) -> NDArray[np.float64]:
        """Times of the recorded steps: array of shape (steps + 1,), s; the first is the start."""
    @property
    def dof_names(self) -> list[str] | None:
        """Names of the structure's degrees of freedom: list of n texts; None without names."""
    @property
    def largest_gap(self) -> Peak:
        """Largest gap of any element, m, a `Peak`."""
    @property
    def largest_pressure(self) -> Peak | None:
        """Largest pressure of any element, Pa, a `Peak`; None without elements."""
    @property
    def foundations(self) -> list[Summary]:
        """Each foundation separately: list of `Summary`, from left to right."""
    @property
    def serviceability(self) -> list[ServiceCheck]:
        """A check of each limit of service of the simulation: list of `ServiceCheck`."""
    @property
    def is_serviceable(self) -> bool | None:
        """Whether the run stays within all limits of service; None without limits."""
    @property
    def mode_changes(self) -> int:
        """Number of changes of contact mode."""
    @property
    def energy_balance(self) -> EnergyBalance:
        """The `EnergyBalance` at the end."""
    @property
    def energy_error(self) -> float:
        """Largest residual of the energy balance, relative to the largest energy; NaN without an energy balance."""
    @property
    def trials(self) -> int:
        """Number of trials of the search for contact modes: linear solutions, sweeps and iterations of Newton's method."""
    @property
    def fallbacks(self) -> int:
        """Number of steps that the first search method did not solve."""
    @property
    def warnings(self) -> list[str]:
        """List of the texts of warnings: violated assumptions, and steps and elements that are too coarse."""
    @property
    def series(self) -> dict[str, NDArray[np.float64]]:
        """All time series: dict of arrays of shape (steps + 1,), "time" first."""
    @property
    def energy_balances(self) -> dict[str, NDArray[np.float64]]:
        """Terms of the energy balance over time: dict of arrays of shape (steps + 1,), J, in the plane J/m."""
    @property
    def probes(self) -> dict[str, Extremes]:
        """Smallest and largest value of each probe: dict of `Extremes` by its name, in its unit."""
    @property
    def units(self) -> dict[str, str]:
        """SI units of the time series and of the energies: dict of texts by their names, "" for ratios."""
    @property
    def heights(self) -> NDArray[np.float64]:
        """Lower and upper end of each element: array of shape (elements, 2), m above the surface; zero on it."""
    @property
    def faces(self) -> dict[Literal["left_wall", "base", "right_wall"], dict[str, NDArray[np.float64]]]:
        """`FaceForces` over time, at the snapshots of ``contact_every`` of `Simulation.run`: dict of "left_wall", "base"
        and "right_wall"; without walls it has "base" only. Each is a dict of arrays of shape (frames,): "time" (s),
        "thrust", "shear" (N/m), "place" (m), "open_fraction" (a ratio).
        """
    @property
    def envelope(self) -> dict[str, NDArray[np.float64]]:
        """Envelopes of the elements: dict of arrays of shape (elements,): "left", "right", "gap",
        "slip" (m), "static_pressure", "lowest_pressure", "highest_pressure", "shear" (Pa),
        "open" (s); in plan also "front", "back", "slip_across" (m) and "shear_across" (Pa), along y;
        "gap_time", "lowest_pressure_time" and so on are the times of extremes (s).
        """
    @property
    def energy_fractions(self) -> dict[str, float] | None:
        """Fractions of the energy input at the end: dict of numbers by the terms' names; None if the input
        is not positive.
        """
    @property
    def _foundation_peaks(self) -> list[dict[str, float | None]]:
        """Peaks of all scalar quantities of each foundation."""
    @property
    def wall(self) -> float:
        """Wall time, s."""
    def __getitem__(self, key: str, /) -> NDArray[np.float64]: ...
    @property
    def contact(self) -> dict[str, NDArray[Any]]:
        """Snapshots of the base: dict of "time" (frames,), s, and "gap", "slip" (m), "pressure", "shear" (Pa), "mode"
        (numbers into `basemat.MODES`), each of shape (frames, elements); in plan also "slip_across" (m) and
        "shear_across" (Pa), along y.
        """
    @property
    def motion(self) -> dict[str, NDArray[np.float64]]:
        """Snapshots of the structure: dict of "time" (frames,), s, "displacement" and "velocity" (frames, n),
        m and m/s, and "free_field" (frames, 2), m to the right and up; in plan also "free_field_across" (frames,), m along y.
        """
    @property
    def static_displacement(self) -> NDArray[np.float64]:
        """Static displacement of the degrees of freedom, under weight and loads at the start: array of shape (n,), m and rad. It
        is recorded with the motion: give ``motion_every`` to `Simulation.run`.
        """
    def _repr_html_(self) -> str: ...
    def acceleration_record(self, probe: str) -> Record:
        """The `Record` of the acceleration probe called ``probe``."""
    def floor_spectrum(self, probe: str, periods: ArrayLike, damping: float = 0.05) -> Spectrum:
        """Floor (in-structure) response `Spectrum` of the acceleration probe called ``probe`` at ``periods`` (array of
        shape (m,), s) with the damping ratio ``damping`` (0.05 by default). Peaks of the free vibration within one
        period after the end of the run are included: run until the floor is at rest. A `BasematWarning` names periods
        shorter than ten time steps, for which the spectrum needs a run with a shorter step.
        """
    def summary(self) -> dict[str, Any]:
        """Numbers of the run for a table: dict in SI units; peaks with their signs, probes as "peak NAME", and with limits of
        service "is_serviceable".
        """
    def save_npz(self, path: str | os.PathLike[str]) -> None:
        """Writes all time series and snapshots as arrays of numpy to the file at ``path``: ``numpy.load(path)`` returns
        them by names with units, such as "base_shear_n_per_m", in any version and without this package.
        """
    def save_paraview(
        self,
        folder: str | os.PathLike[str],
        name: str,
        structure: _Structure | DeformedShape | None = None,
        *,
        height: float | None = None,
    ) -> int:
        """Writes the snapshots for ParaView into a ``folder``: ``name.pvd``, and a grid of the base for each snapshot of the
        contact. Returns the number of grids.

        With the ``structure`` of the simulation, or its `DeformedShape`, it also writes a grid of the structure for
        each snapshot of the motion; none unless given. ``height`` (m): height of the box that represents a rigid block
        or body, as for `DeformedShape`; None for structures with a shape.
        """
    @property
    def buoyancy(self) -> float:
        """Upward force of the water on the structure, N/m (in plan N): `WaterTable`. The weight is the effective
        ``static_normal_force`` plus this force.
        """
    @property
    def shear_coefficient(self) -> float | None:
        """Ratio of the largest base shear to the weight; None if the structure has no weight."""
    def animate(
        self,
        scale: float | None = None,
        *,
        structure: Structure | UserStructure | DeformedShape | None = None,
        height: float | Sequence[float | None] | None = None,
        frames: int = 200,
        title: str | None = None,
    ) -> FuncAnimation:
        """Moving picture of gaps, slip, contact modes and pressures of the base, and of the structure.

        It needs snapshots of the contact, and with a structure of its motion: ``contact_every`` and ``motion_every`` of
        `Simulation.run`. Gaps and slips are in mm; in plan the picture is that of `plot_contact_plan`. It plays as fast as the
        run in time, if that is 25 pictures a second at most.

        Args:
            scale: factor on the displacements of the structure. Unless given, a round one that makes the largest a twentieth
                to a tenth of the structure's size.
            structure: the simulation's structure, or its `DeformedShape`, which draws joints as well; none unless given.
            height: height of the box that stands for a rigid block, m, or a list of one for each structure of a group, as for
                `DeformedShape`; None for structures with a shape of their own.
            frames: largest number of pictures; of more snapshots as many are taken at equal distances. 200 by default.
            title: text above the picture; none unless given.

        Returns:
            A ``matplotlib.animation.FuncAnimation``, whose ``save("run.gif")`` or ``save("run.html")`` writes a file; videos such
            as "run.mp4" need the program ffmpeg.
        """
    def contact_frame(self) -> DataFrame:
        """Snapshots of the base as a tidy pandas frame: a row per frame and element.

        Columns: "time" (s), "element", "x" (m), "gap", "slip" (m), "pressure", "shear" (Pa), "mode"; in plan also
        "y", "slip_across" (m) and "shear_across" (Pa), and with walls "z", the height of the element's middle (m).
        """
    def energy_frame(self) -> DataFrame:
        """`Run.energy_balances` as a pandas frame, indexed by the time (s), J/m, in plan J."""
    def envelope_frame(self) -> DataFrame:
        """`Run.envelope` as a pandas frame: a row per element."""
    def floor_spectra(
        self,
        periods: ArrayLike,
        damping: float = 0.05,
        *,
        probes: Sequence[str] | None = None,
    ) -> DataFrame:
        """Floor spectra as a pandas frame: total accelerations (m/s²), a column per probe.

        Args:
            periods: natural periods, array of shape (m,), s: the index of the frame.
            damping: damping ratio; 0.05 by default.
            probes: names of acceleration probes; all those with the unit "m/s²" unless given.
        """
    def foundation_frame(self) -> DataFrame:
        """`Run.foundations` as a pandas frame: a row each, largest values with their signs.

        Columns are ends (m), the static normal force, residual slip, settlement (m) and rotation (rad), and the columns of
        `Run.series`: of a factor of safety the least value; in plan also the directions across: "torque" and others.
        """
    def motion_frame(self, quantity: Literal["displacement", "velocity"] = "displacement") -> DataFrame:
        """The structure's "displacement" or "velocity" as a pandas frame, indexed by the time (s).

        ``quantity``: one of them, "displacement" by default. A column per degree of freedom (m and rad, or
        m/s and rad/s) of the snapshots in `Run.motion`, by its name in `Run.dof_names` or its
        number.
        """
    def plot(
        self,
        axes: Iterable[Axes] | None = None,
        *,
        label: str | None = None,
        color: str | None = None,
        title: str | None = None,
    ) -> list[Axes]:
        """Draws base shear (in plan both), contact modes and energies over time; returns the list of axes.

        Contact modes need snapshots: ``contact_every`` of `Simulation.run`. ``axes``: two of matplotlib to draw into, three
        with snapshots; unless given, axes of a new figure. For several runs in the same axes:
        ``label``, a name before those of the curves, and ``color`` of the base shear; energies have one colour each, and a
        line style for each run; contact modes are those of the first run. ``title`` stands above the picture; None for none.
        """
    def plot_contact_plan(
        self,
        time: float | None = None,
        axes: Axes | None = None,
        *,
        title: str | None = None,
    ) -> Axes:
        """Draws the base in plan at an instant: pressures, open elements, and where sliding ones move; returns the axes.

        It needs snapshots of the contact on a ground in plan: ``contact_every`` of `Simulation.run`. ``time`` (s): the
        snapshot nearest to it is drawn; that with the most open elements unless given. ``axes``: those of matplotlib to draw
        into; unless given, axes of a new figure. ``title`` stands above the picture; the time of the snapshot unless given.
        """
    def plot_modes(self, axes: Axes | None = None, *, title: str | None = None) -> Axes:
        """Draws the contact mode of every element over time, in plan the area of each; returns the axes.

        It needs snapshots of the contact: ``contact_every`` of `Simulation.run`. ``axes``: axes of matplotlib to draw into; of a
        new figure unless given. ``title`` stands above the picture; None for none.
        """
    def plot_moment_rotation(
        self,
        axes: Axes | None = None,
        *,
        foundation: int = 0,
        across: bool = False,
        between: tuple[float, float] | None = None,
        measured: tuple[ArrayLike, ArrayLike] | None = None,
        label: str | None = None,
        color: str | None = None,
        title: str | None = None,
    ) -> Axes:
        """Draws the moment on the soil over the rotation of a foundation, beside measured points; returns the axes.

        ``foundation`` (the first unless given) and ``across`` (False by default) as for `Run.rocking`; ``between``: first and last
        time of the path, s, the whole run unless given. ``measured``: rotations (rad) and moments (N·m/m, in plan N·m), arrays of
        shape (m,), drawn as points; none unless given. ``axes``: those of matplotlib to draw into; unless given, axes of a new figure.
        For several runs in the same axes: ``label``, a name of the path, and its ``color``. ``title`` stands above the picture; None
        for none.
        """
    def plot_settlement_rotation(
        self,
        axes: Axes | None = None,
        *,
        foundation: int = 0,
        across: bool = False,
        between: tuple[float, float] | None = None,
        measured: tuple[ArrayLike, ArrayLike] | None = None,
        label: str | None = None,
        color: str | None = None,
        title: str | None = None,
    ) -> Axes:
        """Draws the settlement over the rotation of a foundation, downwards, beside measured points; returns the axes.

        ``measured``: rotations (rad) and settlements (m), arrays of shape (m,), drawn as points; none unless given. The other
        arguments as for `Run.plot_moment_rotation`: ``foundation`` (the first unless given), ``across`` (False by default),
        ``between`` (s; the whole run unless given), ``axes`` (of a new figure unless given), ``label``, ``color`` and ``title``
        (None for none).
        """
    def plot_wall_pressures(
        self,
        interface: Any = None,
        axes: Iterable[Axes] | None = None,
        *,
        title: str | None = None,
    ) -> list[Axes]:
        """Draws pressures at rest, lowest and highest pressures over the height of both walls; returns the list of two axes.

        Pressures are means over the elements of a ground in a trench. ``interface``: the laws of the simulation,
        ``simulation.interface``, whose active and passive pressures (`EarthPressure`) are drawn as dashed lines, the passive ones
        where they are below 1.5 times the largest pressure; none unless given. ``axes``: two of matplotlib to draw into; unless
        given, axes of a new figure. ``title`` stands above the picture; None for none.
        """
    def report(
        self,
        path: str | os.PathLike[str],
        simulation: Simulation | None = None,
        *,
        interaction: Interaction | None = None,
        height: float | Sequence[float | None] | None = None,
        title: str = "Earthquake response",
    ) -> None:
        """Writes the run as one page to the file at ``path``, which any browser opens without a network: pictures are in it.

        The page has the ground motion, the model, warnings, peaks, limits of service and the text of the run; pictures of time
        series, floor spectra of all acceleration probes, pressures on walls below the surface and, with snapshots (``contact_every`` and ``motion_every`` of
        `Simulation.run`), of the contact, the deformed structure, moments of a `FemModel`'s shells and all in motion. The model is a table of all parameters with
        their units and a program that makes the run again, with its arrays as a file that the page holds. A page that cannot
        be written leaves the one before as it was.

        Args:
            path: name of the file, such as "run.html".
            simulation: the simulation of the run, for its motion and model; only what the run knows unless given.
            interaction: peaks on a fixed base, from `Simulation.interaction`; none unless given.
            height: height of the box that stands for a rigid block, m, or a list of one for each structure of a group, as for
                `DeformedShape`; None for structures with a shape of their own.
            title: heading of the page, "Earthquake response" by default.
        """
    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the run with its time series to a file at ``path``, for `load`.

        The file is for this version of the package; frames, arrays and `Run.summary` are for
        longer keeping.
        """
    def to_frame(self) -> DataFrame:
        """All time series as a pandas frame, indexed by the time (s).

        Units of the columns of this and of all other frames are in ``frame.attrs["units"]``. Frames of a run have its ground
        motion in ``frame.attrs["ground_motion"]``: peak, duration and time step in words.
        """
    def to_xarray(self) -> Dataset:
        """The run as an ``xarray.Dataset``, with the unit of each variable in ``attrs["units"]``; it needs xarray.

        Time series are along "time" (s), energies are called "energy_…", envelopes "envelope_…" along "element". Snapshots of the
        contact, "contact_…", are along "contact_time" and "element", with the names of the modes in ``attrs["modes"]``; those of the
        structure, "displacement" and "velocity", are along "motion_time" and "dof". Coordinates "left", "right", "bottom" and
        "top", in plan "front" and "back", are the ends of the elements (m). ``attrs["ground_motion"]`` has the motion in words.
        ``to_netcdf`` writes a file.
        """

@final
class DeformedShape:
    """Points and outlines of a ``structure`` for pictures and for ParaView.

    The degrees of freedom of the structure move the points.

    A `FemModel` is drawn by its elements, a `ShearBuilding` or `StoreyBuilding` by floors and columns; reduced, damped,
    grouped and embedded structures by the structures that they consist of. An object with a method ``deformed_shape()``
    is drawn by the result, as the structures of `basemat.opensees.structure` are. Any other structure is drawn as a box
    of this ``height`` (m) on its base; it is an error unless ``height`` is given. ``height`` may be a list of one for each
    structure of a group. ``joints``: list of `Joint` of the structure, whose sides are drawn as thick lines; none unless given.
    """

    def __new__(
        cls,
        structure: _Structure | DeformedShape,
        *,
        height: float | Sequence[float | None] | None = None,
        joints: Joint | Sequence[Joint] | None = None,
    ) -> Self: ...
    @staticmethod
    def of_points(
        points: ArrayLike,
        rows: Sequence[Sequence[_RowLike]],
        cells: Sequence[Sequence[int]],
    ) -> DeformedShape:
        """Shape by its ``points``: array of shape (points, 2) in the plane, x and y, or of shape (points, 3) in space, x,
        y and z, m; heights are above the ground.

        ``rows``: for each point the rows of its displacements along these axes, two or three. ``cells``: list of the points
        of each line (2), triangle (3), quadrilateral (4) or polygon, by their numbers.
        """
    @property
    def points(self) -> NDArray[np.float64]:
        """Coordinates of the points at rest: array of shape (points, 3), m: x, height and 0 in the plane; x, y and height
        in space.
        """
    @property
    def cells(self) -> list[list[int]]:
        """Outlines: list of the points of each line or polygon, by their numbers."""
    @property
    def _first_joint_cell(self) -> int:
        """Number of the first of `cells` that is a side of a joint; the others follow."""
    @property
    def in_space(self) -> bool:
        """Whether the points move in three directions."""
    def displacements(self, displacement: ArrayLike) -> NDArray[np.float64]:
        """Displacements of the points along the axes of `points`: array of shape (points, 3), m.

        ``displacement``: all n degrees of freedom of the structure, array of shape (n,), m and rad: a row of
        ``run.motion["displacement"]``, a static displacement or a vibration mode.
        """
    def save_paraview_state(self, path: str | os.PathLike[str], displacement: ArrayLike) -> None:
        """Writes the shape with the displacements by ``displacement`` (array of shape (n,), m and rad) to the file at ``path``
        for ParaView, one grid (.vtu): a single state, such as the static one or a vibration mode.
        """
    def plot(
        self,
        displacement: ArrayLike | None = None,
        *,
        scale: float | None = None,
        axes: Axes | None = None,
        label: str | None = None,
        color: str | None = None,
        title: str | None = None,
    ) -> Axes:
        """Draws the structure at rest in grey, and moved by a displacement; returns the axes.

        In space the view is isometric, from the front, the right and above, and near faces hide far ones.

        Args:
            displacement: all n degrees of freedom, array of shape (n,), m and rad: a row of ``run.motion["displacement"]``,
                a static displacement or a vibration mode. Unless given, only the structure at rest is drawn.
            scale: factor on the displacement. Unless given, a round one that makes the largest displacement a twentieth to a
                tenth of the structure's size; of further states in the same axes that of the first.
            axes: axes of matplotlib to draw into; unless given, axes of a new figure. For several states in the same axes give
                each a ``label``.
            label: name of the state in the key, to which the scale is added; the scale alone unless given.
            color: colour of the moved structure; blue, then matplotlib's next, unless given.
            title: text above the picture; none unless given.
        """
    def to_pyvista(
        self,
        displacement: ArrayLike | None = None,
        *,
        scale: float | None = None,
    ) -> UnstructuredGrid:
        """The shape as a ``pyvista.UnstructuredGrid``, which ``plot()`` shows and one can turn; it needs PyVista.

        ``displacement``: all n degrees of freedom, array of shape (n,), m and rad, as for `DeformedShape.plot`; the shape at rest
        unless given. ``scale``: factor on the displacements of the points; unless given, a round one that makes the largest a
        twentieth to a tenth of the structure's size. Point data "displacement" (m) is not scaled; field data "scale" has the
        factor, and "units" the unit of each array as texts "name: unit".
        """

@final
class ServiceCheck:
    """Comparison of a run with a limit of service."""

    @property
    def criterion(self) -> Literal["slip", "gap", "uplifted_fraction", "rotation", "settlement"]:
        """The limited response: "slip", "gap", "uplifted_fraction", "rotation" or "settlement"."""
    @property
    def limit(self) -> float:
        """Limit of the response, in SI units."""
    @property
    def largest(self) -> Peak:
        """The run's value furthest from zero, a `Peak` in SI units."""
    @property
    def first_excess(self) -> float | None:
        """End of the first step beyond the limit, s; None if there was none."""
    @property
    def is_met(self) -> bool:
        """Whether the run stays within the limit."""
    @property
    def margin(self) -> float:
        """Unused fraction of the limit; below zero where it is exceeded."""

@final
class DofCombination:
    """A weighted sum of a structure's degrees of freedom: where a probe reads and a load acts.

    ``terms``: a degree of freedom's number (from 0), a dict ``{dof: weight}``, a list of pairs
    ``(dof, weight)``, an array of all n weights, or another row. Arguments that are rows may have any of these forms.
    Rows add, subtract and scale.
    """

    def __new__(cls, terms: _RowLike) -> Self: ...
    @property
    def terms(self) -> list[tuple[int, float]]:
        """List of pairs ``(dof, weight)``."""
    def value(self, dofs: ArrayLike) -> float:
        """The sum for the values ``dofs`` of the degrees of freedom (array of shape (n,)), in their unit."""
    def weights(self, dofs: int) -> NDArray[np.float64]:
        """All weights as an array of shape (n,) for a number n of degrees of freedom, ``dofs``."""
    @staticmethod
    def of_base(structure: _Structure, place: Sequence[float]) -> list[DofCombination]:
        """The three `DofCombination` of the displacements along x, along y and up of a point that moves with the base of
        the ``structure`` as one rigid body. ``place``: position from the middle of the base (x, y, height; m).
        """
    def relative_to_base(self, structure: _Structure) -> DofCombination:
        """This displacement to the right, relative to the middle of the base of the ``structure``; in plan subtract a row of
        `of_base`.
        """
    def total_drift(self, structure: _Structure, height: float) -> DofCombination:
        """This displacement to the right minus the rigid motion of the base of the ``structure``, whose rotation acts at
        ``height`` (m) above the base: the lateral deformation.
        """
    def __add__(self, value: _RowLike, /) -> DofCombination: ...
    def __sub__(self, value: _RowLike, /) -> DofCombination: ...
    def __neg__(self) -> DofCombination: ...
    def __mul__(self, value: float, /) -> DofCombination: ...
    def __rmul__(self, value: float, /) -> DofCombination: ...
    def __truediv__(self, value: float, /) -> DofCombination: ...
    def __eq__(self, value: object, /) -> bool: ...

@final
class SectionRows:
    """A section's resultant: rows of ``displacement``, ``velocity`` and ``acceleration`` whose sum is a force or a moment.
    ``unit``: "N/m" (the default) or "N·m/m", in plan "N" or "N·m". `Probe.section` records the sum.
    """

    def __new__(
        cls,
        displacement: _RowLike,
        velocity: _RowLike,
        acceleration: _RowLike,
        *,
        unit: _SectionUnit = "N/m",
    ) -> Self: ...
    @property
    def unit(self) -> str:
        """SI unit of the resultant: "N/m" or "N·m/m", in plan "N" or "N·m"."""
    @property
    def displacement(self) -> DofCombination:
        """The `DofCombination` of displacements."""
    @property
    def velocity(self) -> DofCombination:
        """The `DofCombination` of velocities."""
    @property
    def acceleration(self) -> DofCombination:
        """The `DofCombination` of accelerations."""
    def __getnewargs_ex__(
        self,
    ) -> tuple[tuple[DofCombination, DofCombination, DofCombination], dict[str, Any]]: ...

@final
class Simulation:
    """Simulation of a structure on a ground, from its static state on.

    Args:
        time_step: time step, s.
        structure: a `Structure`, or any object with the methods of `UserStructure`.
        ground: a `Ground`: an `ElasticGround`, `SpringGround` or `TrenchGround`; or any object with the methods of
            `UserGround`.
        interface: an `InterfaceLaw` or an object with the methods of `UserLaw`; one law for all contact elements, or a
            list with a law for each element, from left to right.
        motion: ground motion, a `FreeField`: a `Record`, a wave, or a function (`free_field`). Without a motion the
            ground is at rest.
        joints: contact between lines of nodes of the structure, a list of `Joint`; none unless given.
        loads: forces from outside, a list of `Load`; none unless given.
        probes: quantities to record at every step, a list of `Probe` with different names; none unless given.
        initial: weight and motion at the start, `InitialConditions`; weight and rest unless given.
        solver: time scheme, coordinates and so on, `SolverOptions`; the defaults unless given.
        results: quantities that a run evaluates, `ResultOptions`; the defaults unless given.
        service_limits: limits of service, `ServiceLimits`; none unless given.
        fixed_base: whether the base is fixed: each foundation keeps its shape and moves with the free field under it.
            Ground and interface then have no effect, except for the positions of the contact elements. False by
            default; `interaction` compares the fixed base with the ground.
        progress: True for a line on stderr, or a function ``(parts done, parts in all)``, while the convolution weights
            of a ground with layers or a trench are computed for the expected steps; none unless given.
    """

    @property
    def state(self) -> State:
        """The `State` at the end of the last accepted step (at first: the static state)."""
    @property
    def time_step(self) -> float:
        """Time step, s."""
    @property
    def probe_names(self) -> list[str]:
        """Names of the probes, in their order."""
    @property
    def elements(self) -> list[tuple[float, float]]:
        """Ends of the contact elements: list of (left, right), m."""
    @property
    def static_displacement(self) -> NDArray[np.float64]:
        """Static displacement of the degrees of freedom: array of shape (n,), m and rad."""
    @property
    def history_choice(self) -> str | None:
        """Text with the method by which the ground computes its history; None for a ground without history."""
    @property
    def structure(self) -> Any:
        """The argument ``structure``; for a structure written in Python with a method ``force``, the copy in this
        simulation, with its internal variables.
        """
    @property
    def ground(self) -> Any:
        """The argument ``ground``; for a ground written in Python, the copy in this simulation."""
    @property
    def interface(self) -> Any:
        """The argument ``interface``: a law, or the list of laws."""
    @property
    def motion(self) -> FreeField | None:
        """The argument ``motion``; None without one."""
    @property
    def _arguments(self) -> dict[str, Any]:
        """All arguments by their names; arguments that were not given are None, an empty list or False."""
    @property
    def hysteresis(self) -> list[Any]:
        """The springs of the structure that are written in Python (`UserHysteresis`): list of the copies in this
        simulation, with their internal variables, in the order of storeys or springs.
        """
    @property
    def conditioning(self) -> tuple[float, float, float]:
        """Condition numbers of the three matrices of a step: effective stiffness, ground, contact problem."""
    def __new__(
        cls,
        time_step: float,
        structure: _Structure,
        ground: _Ground,
        interface: _Interface | Sequence[_Interface],
        *,
        motion: FreeField | None = None,
        joints: Joint | Sequence[Joint] | None = None,
        loads: Load | Sequence[Load] | None = None,
        probes: Probe | Sequence[Probe] | None = None,
        initial: InitialConditions | None = None,
        solver: SolverOptions | None = None,
        results: ResultOptions | None = None,
        service_limits: ServiceLimits | None = None,
        fixed_base: bool = False,
        progress: bool | Callable[[int, int], object] | None = None,
    ) -> Self: ...
    def run(
        self,
        steps: int | None = None,
        *,
        duration: float | None = None,
        progress: bool | Callable[[int, int], object] | None = None,
        observe: Callable[[State], bool | None] | None = None,
        observe_every: int = 1,
        series: bool = True,
        every: int = 1,
        contact_every: int | None = None,
        motion_every: int | None = None,
        foundations: bool = False,
        warn: bool = True,
    ) -> Run:
        """Makes ``steps`` steps, or the steps of a ``duration`` (s); without either, up to the end of the motion.

        If neither is given after the end of the motion, the run makes as many steps again, without acceleration of the
        ground, and issues a `BasematWarning`; `reset` returns to the start.

        ``progress``: True for lines on stderr, one for the convolution weights of the ground and one for the steps; or
        a function ``(steps done, steps in all)``, called about every 50 ms.

        ``observe(state)`` is called after every ``observe_every``th step. The run ends when it returns True. An
        exception of ``observe`` or Ctrl-C also ends the run, and the simulation stays at the last accepted step. A
        `BasematWarning` is issued if the process ignores Ctrl-C.

        ``series``: whether time series are recorded, True by default: the scalars of every ``every``th step (1 by
        default, as floor spectra need), the contact of every ``contact_every``th step and the structure's motion of
        every ``motion_every``th step (none unless given), and with ``foundations`` (False by default) the scalars of
        each foundation. The series of all steps must fit into `memory_limit` before the first step; with ``observe``,
        which may end the run early, only the series of the steps that are made must fit.

        ``warn``: whether every warning in `Run.warnings` is also a `BasematWarning`; True by default.
        """
    def step(self) -> State:
        """Makes one step and returns the new state. A `StepError` is raised if the step has no solution; the simulation is
        then unchanged.
        """
    def steps(self, steps: int | None = None, *, duration: float | None = None) -> Steps:
        """Iterator that makes steps and yields the state after each: ``steps`` steps, or the steps of a ``duration`` (s);
        without either, up to the end of the motion.
        """
    def set_load(self, index: int, value: float | None) -> None:
        """Sets the force of the load with the number ``index`` (from 0, in the order of ``loads``) for all further steps.

        ``value``: the total force (N/m; on a rotation N·m/m; in plan N and N·m), which includes the static force, in
        place of the function of the load; None restores that function. A controller computes the force from the last
        state and sets it before each `step`. A checkpoint contains the force that was set; `reset` restores the
        functions.
        """
    def steps_for(self, duration: float) -> int:
        """Number of steps that last ``duration`` (s), rounded up."""
    def checkpoint(self) -> Checkpoint:
        """The `Checkpoint` of the present state and history, for `resume`."""
    def resume(self, checkpoint: Checkpoint, changes: Sequence[_Change] | None = None) -> None:
        """Returns to the state of ``checkpoint`` (a `Checkpoint`), in a simulation that was built in the same way. In a
        simulation with other sizes, time step, elements, matrices, static state or label of `ResultOptions`, it raises
        a `CheckpointError` that names the difference. The label should name interface law, ground motion and loads.

        Args:
            changes: names of the intended differences, a list; none unless given. "interface_law", "ground_motion" and
                "load" allow another label as well; the other names are "gravity_stage" and "initial_motion".
        """
    def reset(self) -> None:
        """Returns to the start; further steps have the same bits as the first time.

        As for `checkpoint`, a structure written in Python that has ``commit`` must also have ``save`` and ``restore``.
        """
    def interaction(self, duration: float | None = None) -> Interaction:
        """The `Interaction` of the soil with the structure: this scene from its start, run for a ``duration`` (s; the
        duration of the motion unless given) on its ground and on a fixed base, and the period lengthening and damping
        of its first mode (ASCE 7, chapter 19). The state of this simulation is unchanged.

        T and β belong to the mode with the largest participating mass along an axis, with fixed contact nodes; the
        modes of a nonlinear structure are those of its first tangent. For T̃ and β₀ the structure is bonded to its
        ground and released from a deflection in this mode. The soil is linear: give it the moduli of the design motion.
        """
    @property
    def joints(self) -> list[Joint]:
        """The argument ``joints``: list of `Joint`."""
    def push_over_by_displacement(
        self,
        pattern: _RowLike,
        control: _RowLike,
        displacements: ArrayLike,
    ) -> PushOver:
        """The `PushOver` of this scene from its start: static states with growing displacements, through the largest load.

        Weight and the loads at t = 0 act first and stay constant; the motion has no effect. Forces ``pattern`` times a load
        factor follow, which the displacement of ``control`` determines. Uplift, slip, yielding and P–Δ are those of the scene.
        The states are a path, so that unloading and cycles are right. An increment without equilibrium is halved up to eight
        times; then the curve ends, and `PushOver.cause` says why. The state of this simulation is unchanged.

        Args:
            pattern: forces at a load factor of 1, a `DofCombination` or its ``terms``: a degree of freedom, or for a pattern
                over the height the sum of the floors' rows times their weights.
            control: the displacement that is prescribed, a `DofCombination` or its ``terms``. A half-plane has no datum for
                displacements: control a drift or a rotation there. In plan it must be the pattern.
            displacements: values of the control relative to the state under weight and loads, array of shape (n,), m or rad.
                They may grow, fall and change their sign.
        """
    def solid_points(self, element: int, *, member: int | None = None) -> SolidPoints:
        """The `SolidPoints` of an ``element`` (its number in the mesh) at the end of the last accepted step: strains,
        stresses, plastic strains and mobilised strengths at its integration points. The structure is a `FemModel` or
        `WithElements`, also one inside `WithSprings`, `WithModalDamping` or `WithWalls`, or the structure ``member`` (0: the first; none unless
        given) of a `StructureGroup`. While `run` calls ``observe``, this method raises an `Error`: use a loop over `steps`
        instead.
        """
    def beam_sections(self, element: int, *, member: int | None = None) -> BeamSections:
        """The `BeamSections` of a beam of fibres with the number ``element`` at the end of the last accepted step: curvatures,
        axial forces, moments, and strains and stresses of all fibres. Structure and ``member`` (none unless given) are as for
        `solid_points`.
        """
    def hinge_state(self, element: int, *, member: int | None = None) -> HingeState:
        """The `HingeState` of a hinge with the number ``element`` at the end of the last accepted step: rotation, moment, and what
        of the deformations is plastic. Structure and ``member`` (none unless given) are as for `solid_points`.
        """
    def solid_values(
        self,
        quantity: Literal["plastic_strain", "mobilised_strength"],
        *,
        member: int | None = None,
    ) -> tuple[list[int], NDArray[np.float64]]:
        """One value for each element whose material yields, at the end of the last accepted step: the list of their numbers, and
        an array of shape (elements,), for `Mesh.plot_solids`. Structure and ``member`` (none unless given) are as for
        `solid_points`.

        ``quantity``: "plastic_strain", the mean plastic shear strain of the element, or "mobilised_strength", the largest
        ratio of shear stress to shear strength at its points.
        """

@final
class FoundationState:
    """A foundation at the end of a step; forces act from the structure on the soil, per metre
    of thickness in the plane, of the whole body in plan (N and N·m).
    """

    @property
    def elements(self) -> tuple[int, int]:
        """Number of the first element, and one more than the number of the last element."""
    @property
    def shear(self) -> float:
        """Horizontal force on the soil, positive to the right, N/m."""
    @property
    def moment(self) -> float:
        """Moment on the soil about its middle, counter-clockwise, N·m/m; in plan about y by the right-hand rule, N·m."""
    @property
    def normal_force(self) -> float:
        """Total pressure, N/m."""
    @property
    def uplifted_fraction(self) -> float:
        """Ratio of the open length to the length of the foundation, in plan of the open area to the area."""
    @property
    def mean_slip(self) -> float:
        """Slip averaged over the foundation, m."""
    @property
    def rotation(self) -> float:
        """Rotation of the foundation's chord, counter-clockwise, rad; in plan about y by the right-hand rule."""
    @property
    def settlement(self) -> float:
        """Settlement of its centre since the static state, positive downwards, m."""
    @property
    def rocking_work(self) -> float:
        """Work of its moment on the soil since the start, ∫M dθ, J/m; in plan about y, J."""
    @property
    def shear_across(self) -> float:
        """In plan: force on the soil along y, positive away, N."""
    @property
    def moment_across(self) -> float:
        """In plan: moment on the soil about x, N·m."""
    @property
    def torque(self) -> float:
        """In plan: moment on the soil about the vertical axis, counter-clockwise from above, N·m."""
    @property
    def mean_slip_across(self) -> float:
        """In plan: slip along y averaged over the foundation, m."""
    @property
    def rotation_across(self) -> float:
        """In plan: rotation about x, rad."""
    @property
    def rocking_work_across(self) -> float:
        """In plan: work of the moment about x on the soil since the start, J."""
    @property
    def twist(self) -> float:
        """In plan: rotation about the vertical axis, counter-clockwise from above, rad."""
    @property
    def force_vector(self) -> list[float]:
        """Force on the soil as a vector, N/m; in plan along x, y and up, N. In the plane axes point to the right, up and towards the reader."""
    @property
    def moment_vector(self) -> list[float]:
        """Moment on the soil about its middle as a vector by the right-hand rule, N·m/m, in plan N·m."""
    @property
    def rotation_vector(self) -> list[float]:
        """Rotation as a vector by the right-hand rule, rad."""

@final
class FaceForces:
    """Forces on the soil at one face of a structure in the ground.

    They are per metre of thickness. `State.face` returns them.
    """

    @property
    def thrust(self) -> float:
        """Total pressure, positive in compression, N/m."""
    @property
    def shear(self) -> float:
        """Force on the soil along the outline, N/m: positive down the left wall, to the right along the base, up the right wall."""
    @property
    def place(self) -> float:
        """Position of the thrust, m: on a wall its height above the base, on the base its distance to the right of the
        middle. NaN without thrust.
        """
    @property
    def open_fraction(self) -> float:
        """Ratio of the length of open elements to the length of the face."""

@final
class JointState:
    """A joint at the end of a step; forces act from the upper side on the lower side, per metre of thickness."""

    @property
    def gap(self) -> NDArray[np.float64]:
        """Gap of each element: array of shape (elements,), m."""
    @property
    def slip(self) -> NDArray[np.float64]:
        """Slip of each element, of the upper side in the sense of the joint's nodes: array of shape (elements,), m."""
    @property
    def pressure(self) -> NDArray[np.float64]:
        """Pressure on each element: array of shape (elements,), Pa."""
    @property
    def shear(self) -> NDArray[np.float64]:
        """Shear traction on each element, on the lower side: array of shape (elements,), Pa."""
    @property
    def modes(self) -> NDArray[np.uint8]:
        """Mode of each element: array of shape (elements,) of numbers into `basemat.MODES`."""
    @property
    def transitions(self) -> list[tuple[int, str, str]]:
        """Changes of mode in this step: list of tuples (element, mode before, mode now)."""
    @property
    def normal_force(self) -> float:
        """Total pressure, positive in compression, N/m."""
    @property
    def shear_force(self) -> float:
        """Force along the joint on the lower side, positive in the sense of the joint's nodes, N/m."""
    @property
    def moment(self) -> float:
        """Moment of the pressures about the middle of the joint, N·m/m: positive if the pressure is larger before the
        middle, in the sense of the nodes.
        """
    @property
    def open_fraction(self) -> float:
        """Ratio of the length of open elements to the length of the joint."""
    @property
    def mean_slip(self) -> float:
        """Slip averaged over the joint, m."""
    @property
    def largest_gap(self) -> float:
        """Largest gap of an element, m."""
    @property
    def contact_energy(self) -> float:
        """Energy lost by friction and impact since the start, J/m; NaN if the energy balance is omitted."""

@final
class Load:
    """A force that acts on a structure from outside.

    ``row``: where it acts, a `DofCombination` or its ``terms``. ``value``: a function of time (s) that returns the
    force (N/m; on a rotation a moment, N·m/m); it may raise an exception. In plan forces are in N and moments in N·m.
    Its value at t = 0 belongs to the static state: it is applied slowly after the weight, while the interface law acts.
    """

    def __new__(cls, row: _RowLike, value: Callable[[float], float]) -> Self: ...
    @staticmethod
    def constant(row: _RowLike, force: float) -> Load:
        """Constant ``force`` (N/m) on the ``row`` at any time, the static state included."""
    @staticmethod
    def weight(row: _RowLike, force: float) -> Load:
        """Constant ``force`` (N/m) on the ``row`` that is applied together with the weight, according to ``gravity_stage``
        of `InitialConditions`: a dead load whose mass is not in the structure.
        """
    @staticmethod
    def released(row: _RowLike, force: float) -> Load:
        """A ``force`` (N/m) on the ``row`` in the static state that is removed at the first step (snap-back)."""
    @staticmethod
    def record(row: _RowLike, record: Record, force: float) -> Load:
        """``force`` (N/m) on the ``row`` multiplied by the accelerations of a ``record`` as numbers without unit, linear
        between its samples and zero beyond its ends.
        """
    @staticmethod
    def table(row: _RowLike, times: ArrayLike, forces: ArrayLike) -> Load:
        """Forces on the ``row`` from a table: ``forces`` (array of shape (m,), N/m) at ``times`` (array of shape (m,), s,
        ascending), linear between these times, zero before the first and after the last.
        """

@final
class InitialConditions:
    """Weight and motion at the start of a simulation.

    Args:
        gravity: acceleration of gravity, which determines the weight of the structure, m/s²; 9.80665 unless given. With
            0 there is no static state: the base begins without pressure, and nothing resists uplift and sliding.
        gravity_stage: friction while the weight of masses and `Load.weight` is applied; all other loads at t = 0 are
            applied slowly after it, while the interface law acts. "frictionless" (the default): neither friction nor
            cohesion, and the base sticks from then on; "frictional": the interface law acts, in one step;
            "wished_in_place": walls and base in the ground replace soil at rest, for comparisons; "unloaded": there is
            no static state, weight and loads act from t = 0 on, as for a block that is released.
        water_table: `WaterTable` of a base on the surface: its pressure acts up on the base from the beginning, and contact
            is effective; none unless given.
        displacement: displacement of the n degrees of freedom at t = 0 from the static state, array of shape (n,), m
            and rad; zero unless given. The base may be displaced only if ``gravity_stage`` is "unloaded".
        velocity: velocity of the n degrees of freedom at t = 0, array of shape (n,), m/s and rad/s; zero unless given.
    """

    def __new__(
        cls,
        *,
        gravity: float | None = None,
        gravity_stage: _GravityStage = "frictionless",
        water_table: WaterTable | None = None,
        displacement: ArrayLike | None = None,
        velocity: ArrayLike | None = None,
    ) -> Self: ...

@final
class SolverOptions:
    """Numerical methods of a simulation.

    Args:
        scheme: a `TimeScheme`; the midpoint rule, which conserves energy, unless given.
        coordinates: coordinates of the equations of motion of a linear structure. "auto" (the default): the choice of
            "physical" and "modes" that takes less time; "physical": its degrees of freedom; "modes": its vibration
            modes; a number: reduced coordinates, 200 to 400 Ritz vectors for thousands of degrees of freedom, with this
            relative error of responses (above 0, below 1; "reduced(1e-6)" is the same as 1e-6).
        expected_steps: number of steps that will be made. Memory and convolution weights of the ground are prepared for
            them before the first step; unless given, for the steps of the first run. An error is raised if the steps do
            not fit into the memory of the history of the ground.
        rotation_limit: rotation of the base, about a horizontal axis, at which a run ends, rad; 1 unless given. A
            further run continues; with ``math.inf`` the rotation ends no run.
        flow_chart_iterations: searches contact modes by the flow chart of Patel and Spyrakos with at most this number
            of iterations a step, for comparison with their paper; the robust search unless given.
    """

    def __new__(
        cls,
        *,
        scheme: TimeScheme | None = None,
        coordinates: _Coordinates | float | None = None,
        expected_steps: int | None = None,
        rotation_limit: float | None = None,
        flow_chart_iterations: int | None = None,
    ) -> Self: ...

@final
class ResultOptions:
    """Quantities that a run evaluates; they do not change the motion.

    Args:
        moment_center: x of the reference point of the base moment, m; the middle of the base unless given.
        energy_balance: whether energies are computed; True by default. Without them steps are faster, and
            `Run.energy_error` is NaN.
        safety_friction: friction coefficient for the factor of safety against sliding; the coefficient of the interface
            law unless given.
        label: text that checkpoints store and `Simulation.resume` compares; it should name the parts that are not
            compared otherwise: interface law, ground motion and loads. Empty unless given.
    """

    def __new__(
        cls,
        *,
        moment_center: float | None = None,
        energy_balance: bool = True,
        safety_friction: float | None = None,
        label: str | None = None,
    ) -> Self: ...

@final
class ServiceLimits:
    """Limits of service for `Run.serviceability`; they do not change the motion.

    Args:
        slip: limit of |mean slip|, m; none unless given.
        gap: limit of the gap of any element, m; none unless given.
        uplifted_fraction: limit of the ratio of the open length to the length of the base, in plan of areas, above 0
            and at most 1; none unless given.
        rotation: limit of the base's |rotation|, rad; none unless given.
        settlement: limit of the base's settlement, m; none unless given.
    """

    def __new__(
        cls,
        *,
        slip: float | None = None,
        gap: float | None = None,
        uplifted_fraction: float | None = None,
        rotation: float | None = None,
        settlement: float | None = None,
    ) -> Self: ...

@final
class TimeScheme:
    """A time scheme of the structure: the midpoint rule unless given."""

    @staticmethod
    def midpoint() -> TimeScheme:
        """The midpoint rule, which conserves energy."""
    @staticmethod
    def dissipative_midpoint(gamma: float = 0.8) -> TimeScheme:
        """The midpoint rule with damping of high frequencies. It is of second order, and its coupling with the soil adds
        no energy. ``gamma``: ½ (the midpoint rule) to 1; 0.8 by default.
        """
    @staticmethod
    def theta(theta: float) -> TimeScheme:
        """The θ rule; ``theta``: ½ (the midpoint rule) to 1. First order above ½."""
    @staticmethod
    def newmark(gamma: float = 0.5, beta: float = 0.25) -> TimeScheme:
        """Newmark's rule, for comparison with papers: its coupling with the soil may add energy. ``gamma`` and ``beta``:
        Newmark's γ and β, by default ½ and ¼ (average acceleration).
        """
    @staticmethod
    def hht_alpha(alpha: float) -> TimeScheme:
        """The rule of Hilber, Hughes and Taylor, for comparison with papers: its coupling with the soil may add energy.
        ``alpha``: −⅓ (most damping) to 0 (none).
        """

@final
class State:
    """The simulation at the end of an accepted step.

    Displacements are changes against the static state, relative to the translation of the free field unless stated
    otherwise. Forces act from the structure on the soil, per metre of thickness in the plane, of the whole body in plan
    (N and N·m). A state belongs to its simulation and cannot be pickled; a `Checkpoint` can.
    """

    @property
    def joints(self) -> list[JointState]:
        """Each joint separately: list of `JointState`, in the order of ``joints`` of the simulation."""
    @property
    def step(self) -> int:
        """Number of steps made."""
    @property
    def time(self) -> float:
        """Time, s."""
    @property
    def gap(self) -> NDArray[np.float64]:
        """Gap of each element: array of shape (elements,), m."""
    @property
    def slip(self) -> NDArray[np.float64]:
        """Slip of each element: array of shape (elements,), m."""
    @property
    def pressure(self) -> NDArray[np.float64]:
        """Pressure on each element: array of shape (elements,), Pa."""
    @property
    def shear(self) -> NDArray[np.float64]:
        """Shear traction on each element: array of shape (elements,), Pa."""
    @property
    def slip_across(self) -> NDArray[np.float64]:
        """In plan: slip of each element along y: array of shape (elements,), m; 0 in the plane."""
    @property
    def shear_across(self) -> NDArray[np.float64]:
        """In plan: shear traction on each element along y: array of shape (elements,), Pa; 0 in the plane."""
    @property
    def probes(self) -> NDArray[np.float64]:
        """Values of the probes: array of shape (probes,), in their order."""
    @property
    def base_shear(self) -> float:
        """Horizontal force on the soil, positive to the right, N/m."""
    @property
    def base_moment(self) -> float:
        """Moment on the soil, counter-clockwise, N·m/m; in plan about y by the right-hand rule, N·m."""
    @property
    def normal_force(self) -> float:
        """Total pressure on the soil, N/m."""
    @property
    def uplifted_fraction(self) -> float:
        """Ratio of the length of open elements to the length of the base, in plan of their area to the area."""
    @property
    def mean_slip(self) -> float:
        """Slip averaged over the base, m."""
    @property
    def largest_slip(self) -> float:
        """Largest |slip| of any element, m."""
    @property
    def base_rotation(self) -> float:
        """Rotation of the base, counter-clockwise, rad; in plan about y by the right-hand rule."""
    @property
    def force_vector(self) -> list[float]:
        """Force on the soil as a vector, N/m; in plan along x, y and up, N. In the plane axes point to the right, up and towards the reader."""
    @property
    def moment_vector(self) -> list[float]:
        """Moment on the soil as a vector by the right-hand rule, N·m/m, in plan N·m."""
    @property
    def rotation_vector(self) -> list[float]:
        """Rotation of the base as a vector by the right-hand rule, rad."""
    @property
    def free_field(self) -> list[float]:
        """Mean displacement (to the right, up) of the free field under the base, m."""
    @property
    def energy_balance(self) -> EnergyBalance:
        """The `EnergyBalance` since the start."""
    @property
    def trials(self) -> int:
        """Number of trials of the search for contact modes: linear solutions, sweeps and iterations of Newton's method."""
    @property
    def displacement(self) -> NDArray[np.float64]:
        """Displacement of the degrees of freedom relative to the free field: array of shape (n,), m and rad."""
    @property
    def absolute_displacement(self) -> NDArray[np.float64]:
        """Displacement of the degrees of freedom including the translation of the free field: array of shape (n,), m and
        rad.
        """
    @property
    def velocity(self) -> NDArray[np.float64]:
        """Total velocity of the degrees of freedom: array of shape (n,), m/s and rad/s."""
    @property
    def acceleration(self) -> NDArray[np.float64]:
        """Total acceleration of the degrees of freedom: array of shape (n,), m/s² and rad/s²."""
    @property
    def modes(self) -> NDArray[np.uint8]:
        """Mode of each element: array of shape (elements,) of numbers into `basemat.MODES`."""
    @property
    def transitions(self) -> list[tuple[int, Mode, Mode]]:
        """Changes of mode in this step: list of tuples (element, mode before, mode now)."""
    @property
    def foundations(self) -> list[FoundationState]:
        """Each foundation separately: list of `FoundationState`, from left to right."""
    @property
    def method(self) -> Literal["active_set", "gauss_seidel", "path", "newton", "proximal"]:
        """Search method of the modes in this step: "active_set", "gauss_seidel", "path", and in plan "newton" or
        "proximal".
        """
    def value(self, quantity: _Quantity) -> float:
        """Value of a ``quantity`` at the end of the step, in its unit: the name of a scalar time series, such as "base_shear", in plan
        also "torque" or "uplifted_area".
        """
    def face(self, face: _Face) -> FaceForces:
        """The `FaceForces` on a ``face`` of a structure in the ground: "left_wall", "base" or "right_wall"; zeros for a wall of
        a base without walls.
        """
    def state_variables(self, element: int) -> list[float]:
        """State variables of the law of an ``element`` (0: the leftmost): list of numbers, empty if the law has none.
        Elements of joints follow those of the ground, joint by joint.
        """

@final
class Steps:
    """Iterator over steps, which yields the `State` at the end of each.

    ``len()`` is the number of remaining steps. `Simulation.steps` creates it.
    """

    def __iter__(self) -> Steps: ...
    def __next__(self) -> State: ...
    def __len__(self) -> int: ...

@final
class Checkpoint:
    """State of a run between two steps: `Simulation.checkpoint` creates it, `Simulation.resume` continues from it with the
    same bits. It pickles. ``data``: the bytes that `to_bytes` returned.
    """

    def __new__(cls, data: bytes) -> Self: ...
    @property
    def steps(self) -> int:
        """Steps made before the checkpoint."""
    def to_bytes(self) -> bytes:
        """The checkpoint as bytes, for a file."""
    def __getnewargs__(self) -> tuple[bytes]: ...
    def __eq__(self, value: object, /) -> bool: ...

@final
class StrainCurves:
    """Modulus reduction and damping ratio of a soil over shear strain.

    The modulus reduction is G/G_max. A strain of 0.01 is 1 %.
    """

    @staticmethod
    def linear(damping: float) -> StrainCurves:
        """A soil or rock that stays linear, with this ``damping`` ratio."""
    @staticmethod
    def seed_idriss(bound: _CurveBound = "mean") -> StrainCurves:
        """Sand by Seed and Idriss (1970): ``bound`` "mean" (the default), or "upper" for the upper modulus and the lower
        damping.
        """
    @staticmethod
    def vucetic_dobry(plasticity_index: float) -> StrainCurves:
        """Soil with this ``plasticity_index``, per cent, after Vucetic and Dobry (1991)."""
    @staticmethod
    def epri(depth: float) -> StrainCurves:
        """Sand by the ``depth`` (m) of the middle of its layer, after EPRI (1993)."""
    @staticmethod
    def darendeli(
        plasticity_index: float,
        overconsolidation: float,
        mean_stress: float,
        *,
        frequency: float = 1.0,
        cycles: float = 10.0,
    ) -> StrainCurves:
        """Soil after Darendeli (2001) by its ``plasticity_index`` (per cent), overconsolidation ratio
        ``overconsolidation``, effective ``mean_stress`` (Pa), the ``frequency`` (Hz; 1 by default) and the number of
        ``cycles`` (10 by default).
        """
    @staticmethod
    def table(strains: ArrayLike, modulus_ratios: ArrayLike, dampings: ArrayLike) -> StrainCurves:
        """A table: arrays of shape (n,) of increasing ``strains``, of their ``modulus_ratios`` G/G_max and of damping
        ratios, ``dampings``.
        """
    @staticmethod
    def masing(points: ArrayLike, *, small_strain_damping: float = 0.0) -> StrainCurves:
        """Soil whose stress–strain loops follow Masing's rules on a backbone: the equivalent-linear approximation of `Iwan`.

        ``points``: array of shape (n, 2) of shear strain (engineering) and shear stress (Pa), such as ``Iwan.points``.
        The backbone is straight from the origin and between points, and constant beyond the last one. With the area A
        under it up to the strain γ and its stress τ, the damping ratio is ``small_strain_damping`` + (2/π)(2A/(γτ) −
        1). ``small_strain_damping``: damping ratio in addition to that of Masing's loops, often 0.005 to 0.02; 0 by
        default.
        """
    def iwan(self, shear_modulus: float, strength: float, poisson: float, density: float) -> Iwan:
        """The `Iwan` soil that yields along these curves up to a ``strength`` (Pa), with the ``shear_modulus`` G_max (Pa);
        ``poisson`` and ``density`` (kg/m³) are those of `Iwan`.

        The backbone G_max (G/G_max) γ is straight between the points of the curves, and ends where it reaches the
        strength; curves that end below the strength are continued with their last slope. Damping follows from Masing's
        rules, not from the curves of damping.
        """
    def at(self, strains: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """G/G_max and damping ratios at ``strains`` (array of shape (n,)): two arrays of shape (n,)."""

@final
class EquivalentLinear:
    """Response of a site with strain-compatible properties: arrays have one value per layer from the surface down; arrays
    of accelerations end with one more value, of the base under the layers. Printed, it is a table.
    """

    @property
    def depth(self) -> NDArray[np.float64]:
        """Depth of the tops of the layers: array of shape (layers,), m."""
    @property
    def shear_modulus(self) -> NDArray[np.float64]:
        """Strain-compatible shear moduli: array of shape (layers,), Pa."""
    @property
    def modulus_ratio(self) -> NDArray[np.float64]:
        """Ratio of the strain-compatible shear moduli to those at small strain: array of shape (layers,)."""
    @property
    def damping(self) -> NDArray[np.float64]:
        """Strain-compatible damping ratio of each layer: array of shape (layers,)."""
    @property
    def largest_strain(self) -> NDArray[np.float64]:
        """Largest shear strains in the middle of the layers, relative to 1: array of shape (layers,)."""
    @property
    def effective_strain(self) -> NDArray[np.float64]:
        """Effective shear strains, at which the curves were read, relative to 1: array of shape (layers,)."""
    @property
    def peak_acceleration(self) -> NDArray[np.float64]:
        """Largest absolute accelerations of the layer boundaries: array of shape (layers + 1,), m/s²."""
    @property
    def iterations(self) -> int:
        """Number of linear calculations."""
    @property
    def last_change(self) -> float:
        """Estimate of the largest relative change of a modulus or damping ratio that all further iterations would cause."""
    @property
    def warnings(self) -> list[str]:
        """Texts of the warnings."""
    @property
    def accelerations(self) -> NDArray[np.float64]:
        """Accelerations at the tops of layers and base: array of shape (layers + 1, samples), m/s²."""
    @property
    def surface(self) -> Record:
        """Record of the free surface."""
    def profile(self) -> SoilProfile:
        """The site for a ground: strain-compatible moduli at its first frequency, damping constant over the band."""
    def to_frame(self) -> DataFrame:
        """The layers of the site as a pandas frame, indexed by the depth of their tops (m)."""

@final
class Soil:
    """Elastic soil, isotropic and homogeneous.

    ``shear_modulus`` G = ρ c² (Pa), Poisson's ratio ``poisson`` (above −1, below 0.5), ``density`` (kg/m³). A run warns
    if the speed of shear waves is outside 10 to 5 000 m/s or the density outside 500 to 10 000 kg/m³: a usual cause is
    a wrong unit.
    """

    def __new__(cls, shear_modulus: float, poisson: float, density: float) -> Self: ...
    @staticmethod
    def from_shear_wave_speed(speed: float, poisson: float, density: float) -> Soil:
        """Soil from the ``speed`` of its shear waves (m/s), Poisson's ratio ``poisson`` and ``density``
        (kg/m³).
        """
    @staticmethod
    def from_wave_speeds(shear: float, pressure: float, density: float) -> Soil:
        """Soil from the speeds of ``shear`` and ``pressure`` waves (m/s) and its ``density`` (kg/m³)."""
    @property
    def shear_modulus(self) -> float:
        """Shear modulus, Pa."""
    @property
    def poisson(self) -> float:
        """Poisson's ratio, a number."""
    @property
    def density(self) -> float:
        """Density, kg/m³."""
    @property
    def shear_wave_speed(self) -> float:
        """Speed of shear waves, m/s."""
    @property
    def pressure_wave_speed(self) -> float:
        """Speed of pressure waves, m/s."""
    def __hash__(self) -> int: ...
    def __eq__(self, value: object, /) -> bool: ...

@final
class SoilStrength:
    """Strength of drained soil, for `ShallowFooting` and `TrenchGround.interfaces`.

    It has the ``friction_angle`` (rad), its ``cohesion`` (Pa; 0 by default), and the ``wall_friction_angle`` between
    soil and wall (rad; 0 by default), at most the friction angle.

    Stresses are effective stresses. Plane wedges overestimate the passive pressure if the wall friction angle is a
    third of the soil's friction angle or more.
    """

    def __new__(
        cls,
        friction_angle: float,
        *,
        cohesion: float = 0.0,
        wall_friction_angle: float = 0.0,
    ) -> Self: ...
    @property
    def pressure_ratios(self) -> list[float]:
        """Active and passive ratio of the horizontal to the vertical pressure, without cohesion (Coulomb; without wall
        friction Rankine).
        """
    def pressures(self, vertical: float) -> list[float]:
        """Active and passive pressure on a wall under a ``vertical`` pressure of the soil, all Pa."""
    def __eq__(self, value: object, /) -> bool: ...

@final
class WaterTable:
    """Water table: the level below which water at rest presses on a structure.

    It lies ``depth`` below the surface of the ground, m; negative for water above a base on the surface, which lies below the
    water table in reality. ``density``: of the water, kg/m³; 1000 by default.

    The pressure ρ g (z − depth) at the depth z acts up on a base and inwards on walls, also on elements that are open.
    Tractions, factors of safety and friction are then effective. Shaking and gaps do not change the pressure. For a
    base on the surface it is given to `InitialConditions`, in a trench to `TrenchGround`.
    """

    def __new__(cls, depth: float, *, density: float = 1000.0) -> Self: ...
    def __eq__(self, value: object, /) -> bool: ...

@final
class BeamRows:
    """Rows of the forces and moments at the ends of a beam.

    They are rows of displacements for `Probe.section`. `FemModel.beam_rows` returns them.

    At both ends the forces and moments act on a section whose outward normal is x, the axis of the beam. A probe
    records changes from the static state. The rows contain the elastic forces, without damping and inertia; with P–Δ
    also the forces of the geometric stiffness, in the axes of the undeformed beam.
    """

    @property
    def axes(self) -> NDArray[np.float64]:
        """Unit vectors x (along the beam), y and z of the section as rows: array of shape (3, 3), numbers without unit."""
    @property
    def ends(self) -> list[BeamEndRows]:
        """Two `BeamEndRows`, of the first and the second end."""

@final
class BeamEndRows:
    """Forces and moments at one end of a beam, as `SectionRows`: N and N·m, in the plane per metre of thickness."""

    @property
    def node(self) -> int:
        """Number of the node."""
    @property
    def axial(self) -> SectionRows:
        """`SectionRows` of the axial force, N; tension is positive."""
    @property
    def shears(self) -> list[SectionRows]:
        """Two `SectionRows` of the shear forces along y and z, N; the second is zero in the plane."""
    @property
    def torque(self) -> SectionRows:
        """`SectionRows` of the torque about x, N·m; zero in the plane."""
    @property
    def moments(self) -> list[SectionRows]:
        """Two `SectionRows` of the moments about y and z by the right-hand rule, N·m; the first is zero in the plane. Positive
        with tension at positive z, and at negative y.
        """

@final
class BeamSections:
    """States of the n sections along a beam of fibres, each with f fibres.

    `Simulation.beam_sections` and `FemModel.beam_sections` return them. They include the static state. In the plane forces
    are per metre of thickness. `to_frame` and `fiber_frame` are tables.
    """

    @property
    def element(self) -> int:
        """Number of the element."""
    @property
    def position(self) -> NDArray[np.float64]:
        """Positions x, y and z on the undeformed line between the nodes: array of shape (n, 3), m."""
    @property
    def length(self) -> NDArray[np.float64]:
        """Part of the length of the beam for which each section stands: array of shape (n,), m."""
    @property
    def axial_strain(self) -> NDArray[np.float64]:
        """Strain of the line between the nodes, elongation positive: array of shape (n,), numbers without unit."""
    @property
    def curvature(self) -> NDArray[np.float64]:
        """Curvature about z, positive where it stretches the fibres at negative y: array of shape (n,), 1/m."""
    @property
    def axial_force(self) -> NDArray[np.float64]:
        """Axial force, tension positive: array of shape (n,), N."""
    @property
    def moment(self) -> NDArray[np.float64]:
        """Bending moment about z, positive with the curvature: array of shape (n,), N m."""
    @property
    def shear(self) -> NDArray[np.float64]:
        """Shear force along y: array of shape (n,), N."""
    @property
    def curvature_about_y(self) -> NDArray[np.float64]:
        """Curvature about y, positive where it stretches the fibres at positive z: array of shape (n,), 1/m; zero in the plane."""
    @property
    def moment_about_y(self) -> NDArray[np.float64]:
        """Bending moment about y, positive with the curvature about y: array of shape (n,), N m; zero in the plane."""
    @property
    def shear_along_z(self) -> NDArray[np.float64]:
        """Shear force along z: array of shape (n,), N; zero in the plane."""
    @property
    def twist_rate(self) -> NDArray[np.float64]:
        """Change of the rotation about the axis of the beam along it: array of shape (n,), rad/m; zero in the plane."""
    @property
    def torque(self) -> NDArray[np.float64]:
        """Torque, positive with the twist rate: array of shape (n,), N m; zero in the plane."""
    @property
    def fiber_position(self) -> NDArray[np.float64]:
        """Coordinates y and z of the fibres in their section: array of shape (f, 2), m."""
    @property
    def fiber_area(self) -> NDArray[np.float64]:
        """Area of each fibre, the factor of its stress in the resultants: array of shape (f,), m²."""
    @property
    def fiber_strain(self) -> NDArray[np.float64]:
        """Strains of the fibres, tension positive: array of shape (n, f), numbers without unit."""
    @property
    def fiber_stress(self) -> NDArray[np.float64]:
        """Stresses of the fibres, tension positive: array of shape (n, f), Pa."""
    def fiber_frame(self) -> DataFrame:
        """The fibres of all sections as a tidy pandas frame: a row per section and fibre.

        Columns: "section", "fiber" (numbers from 0), "fiber_y", "fiber_z" (m), "area" (m²), "strain" and "stress" (Pa).
        """
    def to_frame(self) -> DataFrame:
        """The sections as a pandas frame: a row per section.

        Columns: "x", "y", "z" (m), "length" (m), "axial_strain", "curvature" (1/m), "axial_force" (N), "moment" (N·m) and "shear"
        (N); in space also "curvature_about_y", "moment_about_y", "shear_along_z", "twist_rate" (rad/m) and "torque".
        """

@final
class BilinearMoment:
    """Moment of a hinge with two straight branches and kinematic hardening, a moment–rotation law.

    ``plastic_moment`` (N m) and rotational ``stiffness`` (N m/rad), in the plane per metre of thickness; ``hardening_ratio``:
    ratio of the stiffness beyond the plastic moment to it, from 0 to below 1.
    """

    def __new__(cls, plastic_moment: float, stiffness: float, hardening_ratio: float) -> Self: ...

@disjoint_base
class Structure:
    """A structure with n degrees of freedom, which only the ground supports.

    Degrees of freedom are in m and rad. Matrices are per metre of thickness in the plane, of the whole structure in
    plan. The object is a description from which each simulation builds a separate structure.
    """

    @property
    def dofs(self) -> int:
        """Number n of degrees of freedom."""
    @property
    def dof_names(self) -> list[str] | None:
        """Names of the degrees of freedom: list of n texts; None without names."""
    def dof(self, name: str) -> DofCombination:
        """The `DofCombination` of the degree of freedom called ``name``, one of `dof_names`."""
    def base(self) -> list[list[BaseNode]] | BaseFaces:
        """Base of the structure: a list for each foundation, of its `BaseNode` from left to right; in plan
        `BaseFaces`.
        """
    def mass(self) -> NDArray[np.float64]:
        """Mass matrix (n × n array, kg/m); matrices become arrays up to 20 000 degrees of freedom."""
    def stiffness(self) -> NDArray[np.float64]:
        """Stiffness matrix (n × n array, N/m per metre)."""
    def damping(self) -> NDArray[np.float64]:
        """Viscous damping matrix (n × n array, N s/m per metre)."""

@final
class RigidBlock(Structure):
    """A rigid block on a flat base, in the plane.

    Its three degrees of freedom are at the middle of its base: displacement to the right, displacement up and rotation.
    `dof` has the names "x", "y" and "rotation" for them.

    ``width`` and ``height``: m. ``density``: kg/m³. ``center``: x of the middle of its base, m; 0 by default.
    ``p_delta``: gravitational acceleration (m/s²) for the P–Δ effect of its weight; no P–Δ effect unless given.
    ``carried_weights``: list of pairs (weight in N/m, height above the base in m) of what stands on the block, such as
    its share of a cap, for the P–Δ effect. These weights themselves act by loads or joints.
    """

    def __new__(
        cls,
        width: float,
        height: float,
        density: float,
        *,
        center: float = 0.0,
        p_delta: float | None = None,
        carried_weights: Sequence[tuple[float, float]] | None = None,
    ) -> Self: ...
    @staticmethod
    def from_mass(
        width: float,
        mass: float,
        rotary_inertia: float,
        center_height: float,
        *,
        center: float = 0.0,
        p_delta: float | None = None,
        carried_weights: Sequence[tuple[float, float]] | None = None,
    ) -> RigidBlock:
        """Block of a ``width`` (m) and a ``mass`` (kg/m) with the ``rotary_inertia`` (kg m²/m) about its
        centre of mass, which is ``center_height`` (m) above the base; ``center`` is as in the class, and so are ``p_delta`` and
        ``carried_weights``, if given.
        """
    def contact_nodes(self, points: ArrayLike) -> list[BaseNode]:
        """Points of the block as contact nodes, a list of `BaseNode`, for a `Joint`. ``points``: array of shape (n, 2) of the
        coordinate x on the surface and the height above the base, m.
        """
    @property
    def total_mass(self) -> float:
        """Mass, kg/m."""
    @property
    def base_inertia(self) -> float:
        """Rotary inertia about the middle of the base, kg m²/m."""
    HORIZONTAL: ClassVar[int]
    VERTICAL: ClassVar[int]
    ROTATION: ClassVar[int]
    def horizontal_at(self, height: float) -> DofCombination:
        """The `DofCombination` of the displacement to the right at a ``height`` (m) above the base."""
    def vertical_at(self, x: float) -> DofCombination:
        """The `DofCombination` of the displacement up at ``x`` (m)."""

@final
class RigidBody(Structure):
    """A rigid body on a flat base, in space.

    Its six degrees of freedom are at the middle of its base: displacements along x (to the right), y (away from the
    viewer) and z (up), rotations about these: "x", "y", "z", "rx", "ry", "rz" for `dof`. Its ground has contact elements
    along x and y: `ElasticGround.under` creates it. `cuboid`, `cylinder` and `from_mass` create the body.
    """

    @staticmethod
    def cuboid(
        length: float,
        width: float,
        height: float,
        density: float,
        *,
        center: tuple[float, float] = (0.0, 0.0),
        p_delta: float | None = None,
    ) -> RigidBody:
        """Homogeneous cuboid: its ``length`` along x, ``width`` along y and ``height`` (m), and its ``density`` (kg/m³).
        ``center``: x and y of the middle of its base, m; (0, 0) by default. ``p_delta``: gravitational acceleration
        (m/s²) for the P–Δ effect of its weight; no P–Δ effect unless given.
        """
    @staticmethod
    def cylinder(
        radius: float,
        height: float,
        density: float,
        *,
        center: tuple[float, float] = (0.0, 0.0),
        p_delta: float | None = None,
    ) -> RigidBody:
        """Homogeneous cylinder that stands on its base: ``radius`` and ``height`` (m), and its ``density`` (kg/m³).
        ``center`` and ``p_delta``, if given, are as in `cuboid`.
        """
    @staticmethod
    def from_mass(
        outline: Sequence[Sequence[float]],
        mass: float,
        inertia: Sequence[Sequence[float]],
        gravity_center: Sequence[float],
        *,
        center: tuple[float, float] = (0.0, 0.0),
        p_delta: float | None = None,
    ) -> RigidBody:
        """Any rigid body on a convex base, by its mass and inertia.

        Coordinates are relative to the point whose motion the degrees of freedom describe. ``outline``: corners of the
        base, list of x and y, m. ``mass``: kg. ``inertia``: tensor about the centre of mass, 3 × 3, kg m², with the
        negative products of inertia off the diagonal. ``gravity_center``: x, y and z of the centre of mass, m.
        ``center``: x and y of that point, m; (0, 0) by default. ``p_delta``, if given, is as in `cuboid`.
        """
    @property
    def total_mass(self) -> float:
        """Mass, kg."""
    def displacement_at(self, x: float, y: float, z: float) -> list[DofCombination]:
        """The three `DofCombination` of the displacements along x, along y and up of the point at ``x``, ``y`` and ``z``
        from the middle of the base (m).
        """

@final
class Storey:
    """A storey of a `ShearBuilding`, per metre of thickness: ``height`` of its columns (m), ``mass``
    of the floor above (kg), lateral ``stiffness`` (N/m), ``rotary_inertia`` of the floor (kg m²; 0 by
    default), ``damping`` by a dashpot between the floors (N s/m; 0 by default).
    """

    def __new__(
        cls,
        height: float,
        mass: float,
        stiffness: float,
        *,
        rotary_inertia: float = 0.0,
        damping: float = 0.0,
    ) -> Self: ...

@final
class ShearBuilding(Structure):
    """Rigid floors on columns that deform in shear, on a rigid base.

    Degrees of freedom: displacement to the right, up, and rotation of the base, then the absolute horizontal
    displacement of every floor from below; for `dof` "base_x", "base_y", "base_rotation", "floor_0", "floor_1" and so
    on. ``width`` of the base: m. ``base_mass``: kg/m. ``base_inertia``: kg m²/m. ``storeys``: list of `Storey`, the
    lowest first. ``damping``: ratio in the first mode on a fixed base, by damping proportional to stiffness; none
    unless given. ``center``: x of the middle of the base, m; 0 by default. ``p_delta``: gravity (m/s²) of the P–Δ
    effect; none unless given. ``laws``: dict ``{storey: law}`` of laws (`Hysteresis` or `UserHysteresis`) that replace
    the stiffness of storeys, storey 0 the lowest; none unless given.
    """

    def __new__(
        cls,
        width: float,
        base_mass: float,
        base_inertia: float,
        storeys: Storey | Sequence[Storey],
        *,
        damping: float | None = None,
        center: float = 0.0,
        p_delta: float | None = None,
        laws: Mapping[int, Hysteresis | UserHysteresis] | None = None,
    ) -> Self: ...
    @staticmethod
    def isolated(
        building: ShearBuilding,
        law: Hysteresis | UserHysteresis,
        *,
        height: float,
        slab_mass: float,
        slab_inertia: float = 0.0,
        damping: float = 0.0,
        laws: Mapping[int, Hysteresis | UserHysteresis] | None = None,
    ) -> ShearBuilding:
        """The ``building`` with its lowest columns on a slab that rests on isolators of this ``law`` (`Hysteresis` or
        `UserHysteresis`). The isolators become storey 0, and the storeys of the building count from 1.

        ``height`` of the bearings: m. ``slab_mass``: kg/m. ``slab_inertia``: kg m²/m; 0 by default. ``damping`` beside
        the bearings: N s/m; 0 by default. ``laws``: laws of further storeys, as for the class; none unless given. The
        ``building`` must have no laws.
        """
    @property
    def total_mass(self) -> float:
        """Mass, kg/m."""
    @property
    def fixed_base_frequency(self) -> float:
        """First natural frequency on a fixed base without P–Δ, Hz."""
    @property
    def roof(self) -> int:
        """Number of the degree of freedom of the topmost floor."""
    def floor(self, storey: int) -> int:
        """Number of the degree of freedom of the floor above a ``storey`` (0: the lowest)."""
    def drift(self, storey: int) -> DofCombination:
        """The `DofCombination` of the drift of a ``storey`` (0: the lowest), m: relative displacement of its two floors,
        without the part due to the rotation of the base.
        """
    def total_drift(self, storey: int) -> DofCombination:
        """The `DofCombination` of the displacement of the floor above a ``storey`` (0: the lowest) minus the rigid motion
        of the base (displacement and rotation), m.
        """
    def shear(self, storey: int) -> SectionRows:
        """The `SectionRows` of the shear force (N/m) in the columns of a ``storey`` (0: the lowest).

        The upper part of the building exerts this force on the lower part. In a storey with a law the force is computed
        from the inertia of the floors above.
        """

@final
class PlanStorey:
    """A storey of a `StoreyBuilding`: ``height`` of its columns (m), ``mass`` of the floor above (kg), a rectangle with the
    ``sides`` along x and y (m), and its ``stiffness``: along x and y (N/m) and against twist about its centre of stiffness (N m).

    ``inertia``: rotary inertia of the floor about x, y and z through its centre of mass (kg m²); unless given, that of
    the rectangle. ``mass_center`` and ``stiffness_center``: x and y from the middle of the mat, m; (0, 0) by default.
    ``damping``: dashpots beside the three stiffnesses, N s/m and N m s; 0 by default.
    """

    def __new__(
        cls,
        height: float,
        mass: float,
        sides: Sequence[float],
        stiffness: Sequence[float],
        *,
        inertia: Sequence[float] | None = None,
        mass_center: Sequence[float] = (0.0, 0.0),
        stiffness_center: Sequence[float] = (0.0, 0.0),
        damping: Sequence[float] = (0.0, 0.0, 0.0),
    ) -> Self: ...

@final
class StoreyBuilding(Structure):
    """Building with rigid floors on a rigid mat, in space.

    The floors stand on flexible columns and walls, and these stand on the ``mat`` (`RigidBody`). Floors move along x
    and y and twist, and tilt with the mat.

    Degrees of freedom: the six of the mat, then the absolute displacements along x and y and the rotation about z of
    every floor from below, at its point above the middle of the mat; for `dof` "x", "y", "z", "rx", "ry", "rz",
    "floor_0_x", "floor_0_y", "floor_0_rz", "floor_1_x" and so on. ``storeys``: list of `PlanStorey`, the lowest first.
    ``p_delta``: gravity (m/s²) of the P–Δ effect; none unless given. ``laws``: dict ``{(storey, direction): law}`` of
    laws (`Hysteresis` or `UserHysteresis`) that replace a stiffness, direction "x", "y" or "twist"; none unless given.
    In the direction "xy" a `Hysteresis` acts along x and y together (``BoucWen`` with an exponent of 2): its force has
    the same limit in every direction. Two laws along x and y act independently: on the diagonal their resultant reaches
    √2 times the limit.
    """

    def __new__(
        cls,
        mat: RigidBody,
        storeys: PlanStorey | Sequence[PlanStorey],
        *,
        p_delta: float | None = None,
        laws: Mapping[tuple[int, _PlanDirection], Hysteresis | UserHysteresis] | None = None,
    ) -> Self: ...
    @property
    def total_mass(self) -> float:
        """Mass of mat and floors, kg."""
    def floor(self, storey: int, place: Sequence[float] = (0.0, 0.0)) -> list[DofCombination]:
        """The three `DofCombination` of the displacements along x and y and of the twist of the floor above a ``storey``
        (0: the lowest) at a ``place`` (x and y from the middle of the mat, m; the middle by default).
        """
    def drift(self, storey: int, place: Sequence[float] | None = None) -> list[DofCombination]:
        """The three `DofCombination` of the deformation of a ``storey`` (0: the lowest), drifts along x and y (m) and twist,
        at a ``place`` (x and y from the middle of the mat, m); at its centre of stiffness unless given.
        """
    def total_drift(self, storey: int, place: Sequence[float] = (0.0, 0.0)) -> list[DofCombination]:
        """The three `DofCombination` of the displacements along x and y and of the twist of the floor above a ``storey``
        (0: the lowest) minus the rigid motion of the mat, at a ``place`` as for `floor`.
        """
    def shear(self, storey: int) -> list[SectionRows]:
        """The three `SectionRows` of the forces along x and y (N) that the floor above a ``storey`` (0: the lowest) exerts
        on the part below, and of their torque about the centre of stiffness (N·m), computed from the inertia of the
        floors above.
        """
    def section(self, storey: int, reference: Sequence[float] = (0.0, 0.0)) -> list[SectionRows]:
        """The six `SectionRows` of shear along x and along y (N), compression (N), moments about x and about y (N·m) and
        torque about z (N·m) that the floors above exert on the part below the foot of a ``storey`` (0: the lowest),
        computed from the inertia of these floors. Moments are about ``reference`` (x and y from the middle of the mat,
        m; the middle by default) at the foot.
        """

@final
class RayleighDamping:
    """Rayleigh damping by a damping matrix a M + b K.

    ``mass``: factor a of the mass matrix, 1/s. ``stiffness``: factor b of the stiffness matrix, s.
    """

    def __new__(cls, mass: float, stiffness: float) -> Self: ...
    @staticmethod
    def from_ratios(frequencies: Sequence[float], ratios: Sequence[float]) -> RayleighDamping:
        """Rayleigh damping with the damping ``ratios`` (a pair) at two ``frequencies`` (a pair, Hz)."""
    @property
    def mass(self) -> float:
        """Factor of the mass, 1/s."""
    @property
    def stiffness(self) -> float:
        """Factor of the stiffness, s."""
    def ratio(self, frequency: float) -> float:
        """Damping ratio at a ``frequency`` (Hz)."""

@final
class ReducedModel(Structure):
    """A ``structure`` reduced by the method of Craig and Bampton.

    The reduced degrees of freedom are the degrees of freedom of the contact nodes, those in the list ``keep`` (none
    unless given), and the amplitudes of the lowest ``modes`` modes of the remaining structure. ``damping_ratio`` of
    these modes replaces the damping of the structure, if given.
    """

    def __new__(
        cls,
        structure: _Structure,
        modes: int,
        *,
        keep: Sequence[int] | None = None,
        damping_ratio: float | None = None,
    ) -> Self: ...
    @property
    def frequencies(self) -> NDArray[np.float64]:
        """Frequencies of the modes: array of shape (modes,), Hz."""
    def row(self, row: _RowLike) -> DofCombination:
        """A ``row`` of the full structure as a `DofCombination` of the reduced structure, for a probe or a load."""
    def full(self, reduced: ArrayLike) -> NDArray[np.float64]:
        """Degrees of freedom of the full structure, array of shape (n,), m and rad, from those of the
        ``reduced`` one, array of shape (dofs,).
        """

@final
class StructureGroup(Structure):
    """Several structures on one ground, coupled through the soil.

    ``members``: list of pairs ``(structure, shift)`` from left to right, each moved to the right by its shift (m); in
    plan in any order, without overlap; their positions along y are unchanged (``center`` of `RigidBody.cuboid`).
    ``above``: list of pairs ``(structure, (shift, height))`` of structures in the plane that touch no ground, each moved
    to the right and upwards (m), none unless given. They stand on others by joints (`Joint`), and count after the members.
    """

    def __new__(
        cls,
        members: Sequence[tuple[_Structure, float]],
        above: Sequence[tuple[_Structure, Sequence[float]]] | None = None,
    ) -> Self: ...
    def row(self, member: int, row: _RowLike) -> DofCombination:
        """A ``row`` of the structure ``member`` (0: the first) as a `DofCombination` of the group."""
    def contact_nodes(self, member: int, nodes: BaseNode | Sequence[BaseNode]) -> list[BaseNode]:
        """Contact ``nodes`` (list of `BaseNode`) of the structure ``member`` (0: the first) as nodes of the group, a list, for
        a `Joint`.
        """

@final
class WithModalDamping(Structure):
    """A ``structure`` with additional damping of its modes.

    ``ratios``: damping ratios of the modes (array of shape (m,)), the lowest mode first; the last ratio is that of all
    further modes.

    With ``fixed_base`` the modes are those on a fixed base, as in codes and tests. Without it (the default) they are
    those of the free structure, whose frequencies are far higher: with a ratio of 5 %, the first mode of five storeys
    on a base then has 0.9 %.
    """

    def __new__(cls, structure: _Structure, ratios: ArrayLike, *, fixed_base: bool = False) -> Self: ...
    @property
    def frequencies(self) -> NDArray[np.float64]:
        """Frequencies of the modes that are not rigid: array of shape (modes,), Hz."""

@final
class WithWalls(Structure):
    """A ``structure`` in the ground: its rigid base lies at a ``depth`` (m) and has walls up to the surface.

    The structure is the same as on the surface: its heights are relative to the base. The ground is a `TrenchGround` of
    this width and depth. A structure with a flexible base needs no `WithWalls`: its ``base`` lists the nodes down the
    left wall, along the base and up the right wall, with their heights ``z`` (`BaseNode`).
    """

    def __new__(cls, structure: _Structure, depth: float) -> Self: ...
    @property
    def depth(self) -> float:
        """Depth of the base, m."""

@final
class FemModel(Structure):
    """A finite-element structure.

    ``mesh``: a `Mesh`. ``contact``: numbers of the nodes that touch the ground from left to right; a list of such lists
    for separate foundations; all lowest nodes unless given. In space: a list of faces, each by its corner nodes, shells
    with their underside; all faces at the lowest height unless given. ``in_trench``: whether ``contact`` is the outline
    of walls and base in a trench, down the left wall, along the base and up the right wall, in a mesh whose y counts
    from the surface; False by default. ``on_soil_at_rest``: whether the outline is that of the soil at rest in the mesh
    (`Mesh.with_stress_at_rest`), which fills a trench, in place of ``contact``; False by default. ``rayleigh``: `RayleighDamping`; none unless given. ``mass``: matrix of masses,
    "consistent" (the default) or "lumped". ``rigid_links``: list of pairs (leader, followers) of nodes that move as one
    body; none unless given. ``diaphragms``: list of such pairs in space, whose nodes at one height follow the leader
    along x, along y and about z; none unless given. ``ties``: list of such pairs, whose nodes at one height have the
    displacements of the leader, as both sides of a soil column; none unless given. ``p_delta``: gravity (m/s²) for the
    weight whose static forces cause the P–Δ effect; none unless given. ``active_damping``: whether damping may add
    energy; by default such damping is an error. ``active_stiffness``: whether matrices of elements may be unsymmetric;
    by default such matrices are an error.

    Elements whose material yields act by a nonlinear force: the matrix of `stiffness` contains the linear elements
    only. Each simulation starts from the undeformed model; `Simulation.solid_points` returns stresses and plastic
    strains.
    """

    def beam_rows(self, element: int) -> BeamRows:
        """The `BeamRows` of the beam with the number ``element``: forces and moments at its ends, in its own axes."""
    def beam_sections(self, element: int) -> BeamSections:
        """The `BeamSections` of a beam of fibres with the number ``element`` in the undeformed model;
        `Simulation.beam_sections` returns those of a simulation.
        """
    def __new__(
        cls,
        mesh: Mesh,
        contact: Sequence[int] | Sequence[Sequence[int]] | None = None,
        *,
        in_trench: bool = False,
        on_soil_at_rest: bool = False,
        rayleigh: RayleighDamping | None = None,
        mass: _Mass = "consistent",
        rigid_links: Sequence[tuple[int, Sequence[int]]] | None = None,
        diaphragms: Sequence[tuple[int, Sequence[int]]] | None = None,
        ties: Sequence[tuple[int, Sequence[int]]] | None = None,
        p_delta: float | None = None,
        active_damping: bool = False,
        active_stiffness: bool = False,
    ) -> Self: ...
    def row(self, node: int, direction: _Direction) -> DofCombination:
        """The `DofCombination` of the motion of a ``node`` in a ``direction`` of the mesh, such as "x"."""
    def dof_at(self, node: int, direction: _Direction) -> int | None:
        """Number of the degree of freedom of a ``node`` in a ``direction`` of the mesh, such as "x"; None if the node has
        no separate one.
        """
    def node_at(self, x: float, y: float, z: float = 0.0) -> int:
        """Number of the node at (``x``, ``y``), in space at (``x``, ``y``, ``z``), m, within a millionth of the extent of
        the model. ``z`` is 0 by default.
        """
    def contact_nodes(self, nodes: Sequence[int]) -> list[BaseNode]:
        """A line of nodes of a model in the plane as contact nodes, a list of `BaseNode`, for a `Joint`. ``nodes``: list of
        their numbers.
        """
    def rigid_motion(
        self,
        direction: _Direction,
        point: Sequence[float] | None = None,
    ) -> NDArray[np.float64]:
        """All n degrees of freedom in a rigid motion in a ``direction`` of the mesh, by 1 m or by 1 rad about ``point`` (x, y
        and z, m; the origin unless given): array of shape (n,), m or rad.
        """
    def section(self, height: float, reference: float = 0.0) -> tuple[SectionRows, SectionRows, SectionRows]:
        """The `SectionRows` of shear (N/m), compression (N/m) and moment (N·m/m) that the part above
        ``height`` (m) exerts on the part below, the moment about (``reference``, ``height``), m;
        ``reference`` is 0 by default.
        """
    def section_in_space(self, height: float, reference: Sequence[float] = (0.0, 0.0)) -> list[SectionRows]:
        """The six `SectionRows` of shear along x and along y (N), compression (N), moments about x and about y (N·m)
        and torque about z (N·m) that the part above ``height`` (m) exerts on the part below in space.

        Moments are about ``reference`` (x and y, m; the origin by default) at this height, by the right-hand rule. No
        element may cross the cut; elements in the plane of the cut belong to the part below. To include the weight
        above, add the acceleration of gravity to the vertical accelerations.
        """
    def pressure_row(self, nodes: Sequence[int]) -> DofCombination:
        """The `DofCombination` of a uniform pressure on a line of ``nodes`` (list of numbers): as the
        row of a `Load`, whose forces are then pressures (Pa).
        """
    def resultant_row(self, nodes: Sequence[int], direction: _Direction) -> DofCombination:
        """The `DofCombination` of a unit force in a ``direction`` ("x" or "y", in space also "z"), spread evenly along a line
        of ``nodes`` (list of numbers): as the row of a `Load` in N/m, in space in N.
        """
    def buckling_factor(self) -> float:
        """Factor of the axial forces of the static state at which the structure buckles."""
    def shell_resultants(self, element: int, displacement: ArrayLike) -> list[ShellResultants]:
        """The `ShellResultants` of the shell with the number ``element`` at its nodes, in its own axes, a list: for all n
        degrees of freedom, ``displacement`` (array of shape (n,), m and rad).

        The ``displacement`` of a state is the change from the ``static_displacement`` of the simulation.
        """
    def shell_rows(self, elements: Sequence[int], axes: _ShellAxes) -> list[ShellRows]:
        """The `ShellRows` at every node of the shells with the numbers ``elements`` (a list), in ascending order of nodes:
        means over these shells, which should be those of one mat or one wall.

        ``axes``: two vectors ``(along, outward)`` (x, y and z), or a function of x, y and z (m) that returns them: e1 is the
        part of the first in the plane of a shell, and the normal n is on the side of the second.
        """
    @property
    def inelastic_elements(self) -> list[int]:
        """Numbers of the elements whose material yields or is a `UserMaterial`, beams of fibres included: list, ascending."""
    def solid_points(self, element: int) -> SolidPoints:
        """The `SolidPoints` of an ``element`` of the undeformed model, with its initial stress; `Simulation.solid_points`
        returns those of a simulation.
        """
    def plot_shell_moments(
        self,
        displacement: ArrayLike,
        elements: Sequence[int] | None = None,
        *,
        view: Literal["plan", "front", "side", "space"] = "space",
        axes: Axes | None = None,
        title: str | None = None,
    ) -> Axes:
        """Draws the principal bending moment of larger magnitude of each shell, mat and walls, in kN·m/m; returns the axes.

        It is that of the mean moments over the corners of the shell; it is positive with tension on the side of −n, as
        `ShellResultants.moments`.

        Args:
            displacement: all n degrees of freedom, array of shape (n,), m and rad: ``run.static_displacement`` plus a row of
                ``run.motion["displacement"]``, which alone gives the moments without those of weight and loads.
            elements: numbers of the shells; all of the model unless given.
            view: "space" (by default), "plan", "front" or "side", as for `Mesh.plot_shells`.
            axes: axes of matplotlib to draw into; unless given, axes of a new figure.
            title: text above the picture; none unless given.
        """

@final
class GmshMesh:
    """A mesh of quadrilaterals from a file of Gmsh.

    ``path`` of the file: formats 4.1 and 2.2, text or binary. Nodes closer than ``merge_within`` (m) become one, no
    nodes unless given.
    """

    def __new__(cls, path: str | os.PathLike[str], *, merge_within: float | None = None) -> Self: ...
    @property
    def surfaces(self) -> list[str]:
        """List of the names of the groups of quadrilaterals."""
    @property
    def lines(self) -> list[str]:
        """List of the names of the groups of lines."""
    def mesh(
        self,
        materials: Mapping[str, _Solid],
        *,
        formulation: _Formulation | None = None,
        hourglass_percent: int = 5,
    ) -> Mesh:
        """The quadrilaterals as a `Mesh`, each with the material of its group: ``materials`` is a dict
        ``{"wall": material}`` of materials as in `Layer`; ``formulation`` and ``hourglass_percent`` are as there, that of each
        material unless given.
        """
    def line(self, name: str) -> list[int]:
        """Numbers of the nodes of the group ``name`` of lines in one piece: list, from left to right."""
    def foundations(self, name: str) -> list[list[int]]:
        """Numbers of the nodes of the group ``name`` of lines, a list for each piece: for the ``contact`` of a
        `FemModel`.
        """

@final
class Concrete:
    """Concrete without tension, a law of fibres.

    In compression the stress follows a parabola to the ``strength`` f_c (Pa) at the strain ``strength_strain``, then a straight
    line to ``ultimate_stress`` (Pa) at ``ultimate_strain``, and is constant beyond. All four are positive. Unloading and
    reloading follow one straight line to a residual strain (Kent and Park 1971; Scott, Park and Priestley 1982). It is OpenSees'
    ``Concrete01``. Where concrete softens, results depend on the lengths of the elements.
    """

    def __new__(
        cls,
        strength: float,
        strength_strain: float,
        ultimate_stress: float,
        ultimate_strain: float,
    ) -> Self: ...

@final
class BilinearSteel:
    """Steel with two straight branches and kinematic hardening, a law of fibres.

    ``yield_stress`` and ``modulus``: Pa; ``hardening_ratio``: ratio of the hardening modulus to it, from 0 to below 1. It is
    OpenSees' ``Steel01`` without isotropic hardening.
    """

    def __new__(cls, yield_stress: float, modulus: float, hardening_ratio: float) -> Self: ...

@final
class MenegottoPinto:
    """Steel with curved branches and the Bauschinger effect, a law of fibres (Menegotto and Pinto 1973).

    ``yield_stress`` and ``modulus``: Pa; ``hardening_ratio``: from 0 to below 1. ``transition``: exponent R₀ of the branches
    and c₁ and c₂, by which it falls with the plastic strain of the last half cycle (three numbers; 15, 0.925 and 0.15 by
    default). ``isotropic_hardening``: a₁ and a₂ for compression, a₃ and a₄ for tension (four numbers; none unless given), which
    shift the asymptotes by a₁ f_y (Δε/(2 a₂ ε_y))^0.8 with the range Δε of strains at reversals. It is OpenSees' ``Steel02``
    without initial stress.
    """

    def __new__(
        cls,
        yield_stress: float,
        modulus: float,
        hardening_ratio: float,
        *,
        transition: Sequence[float] | None = None,
        isotropic_hardening: Sequence[float] | None = None,
    ) -> Self: ...

@final
class FiberSection:
    """Cross-section of fibres, each with an area and a law: for `Mesh.add_fiber_beams` and `Mesh.add_space_fiber_beams`.

    It starts without fibres, and each method returns a section with more of them. Positions are y and z in the axes of the
    beam (m), from the line between its nodes; y points to the left of a beam seen from its first node to the second, and a
    positive curvature stretches the fibres at negative y. Beams in the plane do not depend on z, and their areas are
    per metre of thickness. A ``material`` is a `Concrete`, `BilinearSteel`, `MenegottoPinto`, a linear elastic `Material`
    or a `UserUniaxialMaterial`.
    """

    def __new__(cls) -> Self: ...
    def with_fiber(self, position: Sequence[float], area: float, material: _FiberLaw) -> FiberSection:
        """Adds a fibre of a ``material`` at a ``position`` (y and z, m) with an ``area`` (m²)."""
    def with_fibers(self, positions: ArrayLike, areas: ArrayLike, material: _FiberLaw) -> FiberSection:
        """Adds fibres of a ``material`` at ``positions`` (array of shape (n, 2) of y and z, m) with ``areas`` (m²; one number or an
        array of one per fibre).
        """
    def with_rectangle(self, corners: ArrayLike, counts: Sequence[int], material: _FiberLaw) -> FiberSection:
        """Adds a rectangle of a ``material`` between two ``corners`` (array of shape (2, 2) of y and z, m), cut into ``counts``
        fibres along y and along z (two numbers).
        """
    def with_ring(
        self,
        center: Sequence[float],
        radii: Sequence[float],
        counts: Sequence[int],
        material: _FiberLaw,
    ) -> FiberSection:
        """Adds a ring of a ``material`` about ``center`` (y and z, m) between two ``radii`` (inside, 0 for a disc, and outside;
        m), cut into ``counts`` rings and sectors (two numbers).
        """
    def with_bars(self, ends: ArrayLike, count: int, bar_area: float, material: _FiberLaw) -> FiberSection:
        """Adds ``count`` bars of a ``material`` and of ``bar_area`` (m²) on a straight line between two ``ends`` (array of shape
        (2, 2) of y and z, m), ends included; a single bar in the middle. Bars do not replace the concrete around them.
        """
    def with_i_section(
        self,
        sizes: Sequence[float],
        thicknesses: Sequence[float],
        counts: Sequence[int],
        material: _FiberLaw,
    ) -> FiberSection:
        """Adds an I-section of a ``material`` about the middle of its height, bent about its strong axis: ``sizes`` are its depth
        over all and its flange width, ``thicknesses`` those of web and flanges (two numbers each, m). Each flange has
        ``counts[0]`` layers of fibres along y, the web ``counts[1]``. Beams in space need `with_i_section_in_space`.
        """
    def with_i_section_in_space(
        self,
        sizes: Sequence[float],
        thicknesses: Sequence[float],
        counts: Sequence[Sequence[int]],
        material: _FiberLaw,
    ) -> FiberSection:
        """Adds an I-section of a ``material``, cut along y and along z, for beams in space; ``sizes`` and ``thicknesses`` are as for
        `with_i_section`.

        ``counts``: fibres along y and along z of each flange, then of the web (array of shape (2, 2)).
        """
    def with_torsional_stiffness(self, stiffness: float) -> FiberSection:
        """Replaces the elastic torsional ``stiffness`` G J (N m²), which beams in space need."""
    @property
    def fiber_count(self) -> int:
        """Number of fibres."""
    @property
    def axial_stiffness(self) -> float:
        """Axial stiffness Σ E A of small strains, N."""

@final
class GmshSpaceMesh:
    """A mesh in space from a file of Gmsh.

    It has points, lines, triangles, quadrilaterals and hexahedra; z points up. ``path``: a file of format 4.1 or 2.2,
    text or binary. Nodes closer than ``merge_within`` (m) are merged, no nodes unless given.
    """

    def __new__(cls, path: str | os.PathLike[str], *, merge_within: float | None = None) -> Self: ...
    @property
    def nodes(self) -> NDArray[np.float64]:
        """Coordinates of the nodes: array of shape (nodes, 3), m. A `mesh` has the same nodes with the same numbers."""
    def groups(self, dimension: int) -> list[str]:
        """List of the names of the groups of a ``dimension``: 0 of points, 1 of lines, 2 of surfaces, 3 of volumes."""
    def cells(self, dimension: int, name: str) -> list[list[int]]:
        """Numbers of the nodes of each element of the group ``name`` of a ``dimension`` (as for `groups`): a list of
        lists. Surfaces are faces for the ``contact`` of a `FemModel`, points are nodes for masses, loads and probes.
        """
    def mesh(self, parts: Mapping[str, _GmshPart]) -> Mesh:
        """The elements of the groups as a `Mesh`: ``parts`` is a dict ``{"wall": part}`` with the parts of
        `Mesh.from_arrays`.

        The part of volumes is a `Material`; of surfaces it is ``(material, thickness)``, in m; of lines it is
        ``(material, section, orientation)`` as in `Mesh.add_space_beams`; None omits a group. Lines and surfaces that
        are sides of other elements need no part. Triangles match the sides that they share with quadrilaterals. To find
        the number of an element of `cells`, look up its nodes in `Mesh.elements`.
        """

@final
class Grid:
    """Nodes of a surface in rows, and the cells between them: from `Mesh.add_grid` and `Mesh.revolve`."""

    def row(self, index: int) -> list[int]:
        """Numbers of the nodes of the row ``index``, a list from the first column on; a pole is a row of one node."""
    def __len__(self) -> int: ...
    @property
    def cells(self) -> list[list[int]]:
        """Corner nodes of the cells between neighbouring rows, for `Mesh.add_shells`: a list of lists of four numbers, of
        three beside a pole, row after row. Corners are listed counter-clockwise, as seen with columns to the right and
        rows upwards; of a wall by `Mesh.revolve`, as seen from outside.
        """
    @property
    def cell_rows(self) -> NDArray[np.uint64]:
        """Number of the lower row of each of `cells`: array of shape (cells,)."""
    def extrude(self, mesh: Mesh, heights: ArrayLike) -> list[list[int]]:
        """Adds nodes to the ``mesh`` at ``heights`` (array of shape (layers,), m, ascending) above the grid, whose cells
        must be counter-clockwise seen from above. Returns the nodes of the bricks between the layers, a list for
        `Mesh.add_bricks`.
        """

@final
class AxialMomentSurface:
    """Axial forces N (tension is positive) and moments M that a section can carry together: a convex set about zero."""

    @staticmethod
    def rectangle(axial_strength: float, plastic_moment: float) -> AxialMomentSurface:
        """Rectangular section of a ductile material: |M|/M_p + (N/N_p)² ≤ 1 with ``axial_strength`` N_p (N) and
        ``plastic_moment`` M_p (N m), in the plane per metre of thickness.
        """
    @staticmethod
    def ellipse(axial_strength: float, plastic_moment: float) -> AxialMomentSurface:
        """Ellipse: (M/M_p)² + (N/N_p)² ≤ 1 with ``axial_strength`` N_p (N) and ``plastic_moment`` M_p (N m), in the plane per
        metre of thickness.
        """
    @staticmethod
    def polygon(corners: ArrayLike) -> AxialMomentSurface:
        """Convex polygon with these ``corners`` [N, M] around zero, in either sense: array of shape (n, 2), N and N m, in the
        plane per metre of thickness.
        """
    def moments_at(self, axial_force: float) -> list[float] | None:
        """Least and largest moment (N m) beside an ``axial_force`` (N); None for a force beyond the strength."""

@final
class HingeState:
    """Deformation and forces of a hinge.

    `Simulation.hinge_state` returns it. Vectors have components along ``axes``: along the member, and at right angles to it.
    A deformation is the motion of the second node relative to the first; a positive deformation causes a positive force. In
    the plane rotation and moment are about the third axis, forces are per metre of thickness, and other components are zero.
    """

    @property
    def element(self) -> int:
        """Number of the element."""
    @property
    def position(self) -> NDArray[np.float64]:
        """Position x, y and z of the undeformed hinge: array of shape (3,), m."""
    @property
    def axes(self) -> NDArray[np.float64]:
        """Unit vectors along the member and at right angles to it: array of shape (3, 3), numbers without unit."""
    @property
    def displacement(self) -> NDArray[np.float64]:
        """Elongation and displacements at right angles to the member: array of shape (3,), m."""
    @property
    def force(self) -> NDArray[np.float64]:
        """Axial force (tension is positive) and shear forces: array of shape (3,), N."""
    @property
    def rotation(self) -> NDArray[np.float64]:
        """Rotation vector, twist first: array of shape (3,), rad."""
    @property
    def moment(self) -> NDArray[np.float64]:
        """Torque and bending moments: array of shape (3,), N m."""
    @property
    def plastic_displacement(self) -> NDArray[np.float64]:
        """Displacement that remains if the force is unloaded elastically: array of shape (3,), m."""
    @property
    def plastic_rotation(self) -> NDArray[np.float64]:
        """Rotation that remains if the moment is unloaded elastically: array of shape (3,), rad."""

@disjoint_base
class Hysteresis:
    """A spring whose force depends on its past deformation: a yield law of a storey, an isolator. Forces and stiffnesses
    are per metre of thickness in the plane, of the whole spring in plan (N and N/m).
    """

    def path(self, deformations: ArrayLike) -> list[float]:
        """Forces (list of m numbers, N/m) of a new spring at the ``deformations`` of a path (array of shape (m,), m)."""

@final
class Bilinear(Hysteresis):
    """Bilinear spring: ``stiffness`` (N/m per metre) up to ``yield_force`` (N/m), then ``hardening`` (0 to 1) times the
    stiffness; it unloads with the initial stiffness.
    """

    def __new__(cls, stiffness: float, yield_force: float, hardening: float) -> Self: ...

@final
class BoucWen(Hysteresis):
    """Bouc–Wen spring: ``stiffness`` (N/m per metre) up to ``yield_force`` (N/m), then ``hardening`` (0 to 1) times the
    stiffness, with a smooth transition that ``exponent`` controls; ``beta`` controls the shape of the loops. Give both
    ``exponent`` and ``beta``, or neither: they are then 2 and 0.5.
    """

    def __new__(
        cls,
        stiffness: float,
        yield_force: float,
        hardening: float,
        *,
        exponent: float | None = None,
        beta: float | None = None,
    ) -> Self: ...

@final
class FrictionPendulum(Hysteresis):
    """Friction pendulum under a ``weight`` (N/m): ``radius`` of its dish (m), ``friction`` coefficient,
    ``yield_displacement`` (m; 0.5 mm by default) before it slides.
    """

    def __new__(
        cls,
        weight: float,
        radius: float,
        friction: float,
        *,
        yield_displacement: float = 0.0005,
    ) -> Self: ...
    def sliding_period(self, gravity: float = 9.80665) -> float:
        """Period of sliding on the dish, s, under a ``gravity`` (m/s²; 9.80665 by default)."""

@final
class PendulumBearing:
    """Friction pendulum that carries the structure, in plan: its weight is the vertical force on it.

    ``weight`` (N; for its stiffness before it slides, and for its friction until the static state is computed),
    ``radius`` of its dish (m), ``friction`` coefficient, ``vertical_stiffness`` (N/m), ``yield_displacement`` (m; 0.5
    mm by default) before it slides. `WithSprings` attaches it to three rows: it slides in any direction, rises on its
    dish, and lifts off. Friction follows the vertical force one step later; moments of that force about the undisplaced
    bearing are neglected.
    """

    def __new__(
        cls,
        weight: float,
        radius: float,
        friction: float,
        vertical_stiffness: float,
        *,
        yield_displacement: float = 0.0005,
    ) -> Self: ...
    def vertical_force(self, deformation: Sequence[float]) -> float:
        """Vertical force (N) on a new bearing at a ``deformation`` (along x, along y and up, m); 0 while it is lifted off."""
    def force(self, deformation: Sequence[float]) -> list[float]:
        """Forces (along x, along y and up, N) of a new bearing at a ``deformation`` (m)."""

@final
class LeadRubber(Hysteresis):
    """Lead–rubber bearing: ``shear_modulus`` (Pa), ``rubber_area`` (m² per metre) and ``rubber_thickness`` (m) of its
    rubber, ``lead_area`` (m² per metre) of its lead; ``stiffness_ratio``: ratio of the initial stiffness to the
    stiffness after yielding, 10 by default.
    """

    def __new__(
        cls,
        shear_modulus: float,
        rubber_area: float,
        rubber_thickness: float,
        lead_area: float,
        *,
        stiffness_ratio: float = 10.0,
    ) -> Self: ...
    @staticmethod
    def from_strength(stiffness: float, strength: float, *, stiffness_ratio: float = 10.0) -> LeadRubber:
        """Bearing of a ``stiffness`` after yielding (N/m per metre) and a ``strength`` (N/m);
        ``stiffness_ratio`` is as in the class.
        """
    @property
    def strength(self) -> float:
        """Strength: force at zero deformation, N/m."""
    @property
    def stiffness(self) -> float:
        """Stiffness after yielding, N/m per metre."""

@final
class WithSprings(Structure):
    """A ``structure`` with hysteretic springs.

    ``springs``: list of pairs ``(row, law)``. The row of degrees of freedom is the spring's deformation (m), the law is
    a `Hysteresis` or `UserHysteresis`.

    In plan an entry may also be ``(row_x, row_y, law)`` with two deformations at a right angle and a `Hysteresis`
    (``BoucWen`` with an exponent of 2): its force (N) has the same limit in every direction. Two separate springs along
    x and y act independently: on the diagonal their resultant reaches √2 times the limit. An entry ``(row_x, row_y,
    row_z, bearing)`` has deformations along x, along y and up, and a `PendulumBearing`.
    """

    def __new__(cls, structure: _Structure, springs: Sequence[_Spring]) -> Self: ...

@final
class Layer:
    """Horizontal layer of a block of quadrilaterals: ``height`` (m), number of ``rows`` of elements,
    ``material`` (`Material`, `Iwan`, `DruckerPrager` or `UserMaterial`).

    ``formulation`` of four-node quadrilaterals: "incompatible_modes" (accurate in bending: that of an elastic material
    unless given), "full" (2 × 2 points), "one_point" (without stiffness against hourglass modes), "hourglass" (one point,
    stabilised with ``hourglass_percent``, 5 by default) or "mean_dilatation" (2 × 2 points with the mean dilatation of the
    element: the only formulation for materials that yield, and theirs unless given).
    """

    def __new__(
        cls,
        height: float,
        rows: int,
        material: _Solid,
        *,
        formulation: _Formulation | None = None,
        hourglass_percent: int = 5,
    ) -> Self: ...

@final
class Material:
    """Elastic material, in plane strain for elements in the plane: Young's modulus ``young_modulus`` (Pa), Poisson's ratio
    ``poisson``, ``density`` (kg/m³).
    """

    def __new__(cls, young_modulus: float, poisson: float, density: float) -> Self: ...

@final
class BeamSection:
    """Cross-section of beams in space: ``area`` (m²), ``second_moments`` I_y = ∫ z² dA and I_z = ∫ y² dA (two numbers,
    m⁴) and ``torsion_constant`` (m⁴).

    y and z are the principal axes: y along the orientation of the beam, z perpendicular to it. ``shear_areas`` along y
    and along z (two numbers, m²) make Timoshenko beams; they are infinite unless given. The shear area of a rectangle
    is 5/6 of its area, its torsion constant about a b³ (1/3 − 0.21 b/a) with sides a ≥ b.
    """

    def __new__(
        cls,
        area: float,
        second_moments: Sequence[float],
        torsion_constant: float,
        *,
        shear_areas: Sequence[float] | None = None,
    ) -> Self: ...

@final
class MatrixModel(Structure):
    """A structure that its mass, stiffness and damping matrices define.

    Matrices are dense or of ``scipy.sparse``.

    ``mass`` (n × n, kg/m) and ``stiffness`` (n × n, N/m per metre) act on absolute displacements (m, rad). The
    structure has no supports; only the ground supports it. ``base``: nodes of the base, a list of `BaseNode` from left
    to right; a list of such lists for several foundations; `BaseFaces` for a ground in plan, where matrices refer to
    the whole body. ``damping`` (n × n, N s/m per metre; none unless given) must be symmetric and positive semi-definite
    unless ``active_damping`` (False by default), and ``stiffness`` symmetric unless ``active_stiffness`` (False by
    default); ``rayleigh``: `RayleighDamping` instead, none unless given. ``dof_names``: list of n different names, for
    `dof`, frames and errors; none unless given.
    """

    def __new__(
        cls,
        mass: _MatrixLike,
        stiffness: _MatrixLike,
        base: _Base,
        *,
        damping: _MatrixLike | None = None,
        active_damping: bool = False,
        active_stiffness: bool = False,
        rayleigh: RayleighDamping | None = None,
        dof_names: Sequence[str] | None = None,
    ) -> Self: ...

@final
class Mesh:
    """Nodes and finite elements in the plane, or in space (`in_space`).

    ``nodes``: array of shape (nodes, 2), m; none unless given. Its methods add elements and return their numbers; after
    an error they have added none.

    In the plane x points to the right and y up, directions are "x", "y" and "rotation", and all quantities are per metre
    of thickness. In space x points to the right, y away and z up; directions are "x", "y", "z", "rotation_x",
    "rotation_y" and "rotation_z", rotations follow the right-hand rule.
    """

    def add_fiber_beams(
        self,
        nodes: ArrayLike,
        section: FiberSection | Sequence[FiberSection],
        mass_per_length: ArrayLike,
        *,
        points: int = 5,
        quadrature: Literal["lobatto", "legendre"] = "lobatto",
        formulation: Literal["displacement_based", "force_based"] = "displacement_based",
        compression: ArrayLike | None = None,
    ) -> list[int]:
        """Adds beams of fibres in the plane on ``nodes`` (array of shape (beams, 2)): ``section``, a `FiberSection` or a list of
        one per beam, and ``mass_per_length`` (kg/m per metre of thickness; one number or an array of one per beam).

        Sections lie at ``points`` points, 2 to 5, of the ``quadrature`` "lobatto" (with points at both ends) or "legendre".
        ``formulation``: "displacement_based" (curvature is linear along a beam: divide members where they yield) or
        "force_based" (equilibrium is exact: one beam is a member). ``compression`` (N per metre; one number or an array of one
        per beam): axial force of P–Δ, none unless given. Sections stay plane, and shear does not deform them.
        `Simulation.beam_sections` returns curvatures, moments and stresses.
        """
    def add_space_fiber_beams(
        self,
        nodes: ArrayLike,
        section: FiberSection | Sequence[FiberSection],
        mass_per_length: ArrayLike,
        orientation: ArrayLike,
        *,
        points: int = 5,
        quadrature: Literal["lobatto", "legendre"] = "lobatto",
        formulation: Literal["displacement_based", "force_based"] = "displacement_based",
        compression: ArrayLike | None = None,
    ) -> list[int]:
        """Adds beams of fibres in space on ``nodes`` (array of shape (beams, 2)): ``section``, a `FiberSection` with a torsional
        stiffness or a list of one per beam, ``mass_per_length`` (kg/m; one number or an array of one per beam) and
        ``orientation`` (x, y and z of a vector, or an array of shape (beams, 3)), whose part perpendicular to the beam is the y
        axis of the section.

        ``points``, ``quadrature``, ``formulation`` and ``compression`` (N; none unless given) are as for `Mesh.add_fiber_beams`.
        Axial force and both moments act on the fibres together; torsion is elastic.
        """
    def add_grid(self, points: ArrayLike) -> Grid:
        """Adds the nodes of a surface at ``points`` (array of shape (rows, columns, 3), m); returns its `Grid`."""
    def revolve(self, axis: Sequence[float], meridian: ArrayLike, sectors: int) -> Grid:
        """Adds the nodes of a surface of revolution; returns its `Grid`.

        ``axis``: x and y (m) of the vertical axis. ``meridian``: radius and height (m) of each row of nodes, array of shape
        (rows, 2); a row on the axis is one node, a pole. ``sectors``: number of columns round the axis, from the direction of
        x towards y.
        """
    def add_hinges(
        self,
        nodes: ArrayLike,
        moment_law: _FiberLaw,
        displacement_stiffness: ArrayLike,
        *,
        rigid_arm: bool = False,
    ) -> list[int]:
        """Adds hinges in the plane between ``nodes`` at one place (array of shape (hinges, 2)), whose moment yields by
        ``moment_law``: a `BilinearMoment`, or a law of fibres with the moment in place of the stress and the rotation in
        place of the strain, such as a `MenegottoPinto`.

        ``displacement_stiffness`` (N/m per metre; one number or an array of one per hinge): stiffness of the springs between
        the displacements of the nodes, 10² to 10⁴ times that of the members. ``rigid_arm``: whether the nodes may lie at a
        distance, which a rigid arm from the first node bridges; False by default. The stiffness of hinges does not count in
        Rayleigh damping. `Simulation.hinge_state` returns rotation and moment.
        """
    def add_interaction_hinges(
        self,
        nodes: ArrayLike,
        axis: Sequence[float],
        displacement_stiffness: Sequence[float],
        rotational_stiffness: float,
        surface: AxialMomentSurface,
        *,
        hardening_ratio: float = 0.0,
        rigid_arm: bool = False,
    ) -> list[int]:
        """Adds hinges in the plane between ``nodes`` at one place (array of shape (hinges, 2)), whose axial force and moment yield
        together on a ``surface``, an `AxialMomentSurface`, by associated flow.

        ``axis``: direction [x, y] of the member from the first to the second node. ``displacement_stiffness``: stiffness along
        and across the axis (two numbers, N/m per metre); ``rotational_stiffness``: N m/rad per metre. ``hardening_ratio``: ratio
        of the stiffness beyond the surface to that within, from 0 (default) to below 1. ``rigid_arm``: as for `add_hinges`.
        """
    def add_space_hinges(
        self,
        nodes: ArrayLike,
        axis: Sequence[float],
        orientation: Sequence[float],
        displacement_stiffness: float,
        rotational_stiffness: Sequence[float],
        plastic_moments: Sequence[float],
        *,
        hardening_ratio: float = 0.0,
        rigid_arm: bool = False,
    ) -> list[int]:
        """Adds hinges in space between ``nodes`` at one place (array of shape (hinges, 2)), whose bending moments yield together:
        (M_y/M_py)² + (M_z/M_pz)² ≤ 1 with ``plastic_moments`` M_py and M_pz (two numbers, N m).

        ``axis``: direction [x, y, z] of the member from the first to the second node; y of the section lies in the plane of the
        axis and ``orientation``. ``displacement_stiffness``: N/m; ``rotational_stiffness``: in torsion and in bending about y
        and z (three numbers, N m/rad). ``hardening_ratio`` (0 by default) and ``rigid_arm``: as for `add_interaction_hinges`.
        """
    @staticmethod
    def in_space(nodes: ArrayLike | None = None) -> Mesh:
        """Mesh in space; ``nodes``: array of shape (nodes, 3), x to the right, y away and z up, m; none unless given."""
    def add_shells(
        self,
        nodes: ArrayLike | Sequence[Sequence[int]],
        material: Material | Sequence[Material],
        thickness: ArrayLike,
    ) -> list[int]:
        """Adds shells of three or four ``nodes``, listed around each: array of shape (shells, 3) or (shells, 4), or a list of
        lists of 3 or 4 numbers. ``material``: `Material`, or a list of one per shell; ``thickness`` (m): one number
        or an array of one per shell.

        The nodes lie in the middle of the thickness. Triangles match the sides that they share with quadrilaterals of the
        same call, so that a uniform stress is exact. Quadrilaterals are better for curved shells.
        """
    def add_bricks(self, nodes: ArrayLike, material: Material) -> list[int]:
        """Adds bricks of a ``material`` (`Material`) on ``nodes``, array of shape (bricks, 8): the lower face
        counter-clockwise seen from above, then the nodes above these.
        """
    def add_space_beams(
        self,
        nodes: ArrayLike,
        material: Material,
        section: BeamSection,
        orientation: ArrayLike,
        *,
        offsets: ArrayLike | None = None,
        releases: Sequence[Sequence[_Direction]] | None = None,
        rotary_inertia: bool = False,
        compression: ArrayLike | None = None,
    ) -> list[int]:
        """Adds beams in space on ``nodes`` (array of shape (beams, 2)), of a ``material`` (`Material`) and a ``section``
        (`BeamSection`), whose y axis is the part of ``orientation`` perpendicular to the beam (x, y and z of a vector,
        or an array of shape (beams, 3)).

        ``offsets``: rigid arms from the first node to the first end and from the second node to the second end (array
        of shape (2, 3), m); none unless given. ``releases``: two lists of directions in the axes of the beam in which
        its first and its second end are free, such as ``([], ["rotation_z"])`` for a hinge; none unless given.
        ``rotary_inertia``: whether cross-sections have rotary inertia in bending, False by default; ``compression`` (N;
        one number or an array of one per beam): axial force of P–Δ, none unless given.
        """
    def __new__(cls, nodes: ArrayLike | None = None) -> Self: ...
    @staticmethod
    def layered_block(left: float, right: float, columns: int, layers: Layer | Sequence[Layer]) -> Mesh:
        """Block of ``columns`` of equal width from ``left`` to ``right`` (m): ``layers`` is a list of
        `Layer` from y = 0 upwards.
        """
    @staticmethod
    def graded_block(grid: ArrayLike, layers: Layer | Sequence[Layer]) -> Mesh:
        """Block with columns between the lines of ``grid`` (array of shape (columns + 1,), x in m, ascending):
        ``layers`` is a list of `Layer` from y = 0 upwards.
        """
    def merge_nodes(self, tolerance: float) -> tuple[int, list[int]]:
        """Merges nodes at the same position within ``tolerance`` (m), so that their elements act on each other. It returns
        the number of removed nodes, and the list of the new numbers of all former nodes. Elements keep their numbers.

        If an element would have the same node twice, or two elements the same nodes, it raises an error and the mesh is
        unchanged.
        """
    @property
    def nodes(self) -> NDArray[np.float64]:
        """Coordinates of the nodes: array of shape (nodes, 2), in space (nodes, 3), m."""
    def add_node(self, x: float, y: float, z: float = 0.0) -> int:
        """Adds a node at (``x``, ``y``), in space at (``x``, ``y``, ``z``), m; returns its number. ``z`` is 0 by default."""
    def add_nodes(self, points: ArrayLike) -> list[int]:
        """Adds nodes at ``points`` (array of shape (n, 2), in space (n, 3), m); returns the list of their numbers."""
    def add_beams(
        self,
        nodes: ArrayLike,
        young_modulus: ArrayLike,
        area: ArrayLike,
        second_moment: ArrayLike,
        density: ArrayLike,
        *,
        shear_stiffness: ArrayLike | None = None,
        rotary_inertia: bool = False,
        compression: ArrayLike | None = None,
    ) -> list[int]:
        """Adds beams on ``nodes`` (array of shape (beams, 2)): ``young_modulus`` (Pa), ``area`` (m²) and ``second_moment``
        (m⁴) per metre of thickness, ``density`` (kg/m³), each one number or an array of one per beam.
        ``shear_stiffness`` (N per metre): shear stiffness of Timoshenko beams, infinite unless given;
        ``rotary_inertia``: whether cross-sections have rotary inertia, False by default; ``compression`` (N per metre):
        axial force of P–Δ, none unless given.
        """
    def add_trusses(
        self,
        nodes: ArrayLike,
        young_modulus: ArrayLike,
        area: ArrayLike,
        density: ArrayLike,
    ) -> list[int]:
        """Adds trusses on ``nodes`` (array of shape (trusses, 2)): ``young_modulus`` (Pa), ``area`` (m² per
        metre of thickness, in space m²), ``density`` (kg/m³), each one number or an array of one per truss.
        """
    def add_springs(self, nodes: ArrayLike, direction: _SpringDirection, stiffness: ArrayLike) -> list[int]:
        """Adds springs between ``nodes`` (array of shape (springs, 2)) in a ``direction`` of the mesh, such as "x", or
        "axial", of ``stiffness`` (N/m, of rotations N·m): one number or an array of one per spring.
        """
    def add_dashpots(
        self,
        nodes: ArrayLike,
        direction: _SpringDirection,
        coefficient: ArrayLike,
    ) -> list[int]:
        """Adds dashpots between ``nodes`` (array of shape (dashpots, 2)) in a ``direction`` of the mesh, such as "x", or
        "axial", of a ``coefficient`` (N s/m, of rotations N·m s): one number or an array of one per dashpot.
        """
    def add_mass(
        self,
        node: int,
        mass: float,
        *,
        rotary_inertia: float | Sequence[float] | None = None,
    ) -> int:
        """Adds a ``mass`` (kg/m, in space kg) at a ``node``, with a ``rotary_inertia`` (kg m²/m; in space three numbers
        about x, y and z, kg m²; none unless given).
        """
    @property
    def elements(self) -> list[list[int]]:
        """Numbers of the nodes of each element, in the order of the elements' numbers: a list of lists."""
    def element_stiffness(self, element: int) -> NDArray[np.float64]:
        """Stiffness matrix of an ``element`` (its number) at small displacements: array of shape (n, n) for its n degrees of
        freedom, node by node in the directions that it has; N/m, N and N·m.
        """
    def node_at(self, x: float, y: float, z: float = 0.0) -> int:
        """Number of the node at (``x``, ``y``), in space at (``x``, ``y``, ``z``), m, within a millionth of the extent of
        the mesh. ``z`` is 0 by default.
        """
    def nodes_at_height(self, y: float, tolerance: float = 1e-09) -> list[int]:
        """Numbers of the nodes at a height (``y`` in the plane, in space z; m) within a ``tolerance`` (m; 1e-9 by
        default): list, from left to right, in space at each x from front to back.
        """
    @staticmethod
    def quad8_block(
        x: ArrayLike,
        y: ArrayLike,
        material: _Solid | Sequence[_Solid | Sequence[_Solid]],
        *,
        initial_stress: ArrayLike | None = None,
    ) -> Mesh:
        """Block of eight-node quadrilaterals between the vertical lines at ``x`` and the horizontal lines at ``y`` (arrays of
        shape (columns + 1,) and (rows + 1,), m, ascending), such as a column or a box of soil.

        ``material``: `Material`, `Iwan`, `DruckerPrager` or `UserMaterial`; or a list of one per row from the bottom, whose
        entries may be lists of one per column from the left. Elements are numbered row by row from the bottom, each from left
        to right. ``initial_stress``: stress xx, yy, zz and xy of the undeformed elements (Pa; tension is positive), four
        numbers or an array of shape (elements, 4); none unless given. Integration is reduced (2 × 2 points).
        """
    def add_quads(
        self,
        nodes: ArrayLike,
        material: _Solid | Sequence[_Solid],
        *,
        formulation: _Formulation | None = None,
        hourglass_percent: int = 5,
        initial_stress: ArrayLike | None = None,
    ) -> list[int]:
        """Adds plane-strain quadrilaterals of a ``material`` and returns their numbers.

        ``nodes``, counter-clockwise: array of shape (quads, 4), or (quads, 8) with the midside nodes last. ``material``:
        `Material`, `Iwan`, `DruckerPrager` or `UserMaterial`, or a list of one per quadrilateral. Quadrilaterals of four nodes
        take a ``formulation`` and ``hourglass_percent`` as `Layer` does. ``initial_stress``: stress xx, yy, zz and xy of the
        undeformed quadrilaterals (Pa; tension is positive), four numbers or an array of shape (quads, 4); none unless given.
        A linear elastic material has none.
        """
    def with_stress_at_rest(self, stress: StressAtRest) -> Mesh:
        """A copy of this mesh in which all present elements are soil that begins at rest, with the stresses ``stress``
        (`StressAtRest`).

        The elements are quadrilaterals of four or eight nodes below the surface y = 0; elements that are added later, such
        as a foundation on the soil, have their weight. Stresses at rest, the weight of the soil and the pressures at rest
        around it are in equilibrium, and all three are left out of a run: the soil does not move on any mesh, it has
        inertia but no weight, and tractions on the trench are changes from the state at rest. The material yields under the
        whole stress, which `Simulation.solid_points` returns. ``FemModel(mesh, on_soil_at_rest=True)`` takes such a mesh: the
        soil fills a trench, and its sides touch the trench, the surface or other soil at rest.

        A stress at rest outside the yield surface is an error with its element and depth.
        """
    @staticmethod
    def from_arrays(points: ArrayLike, cells: Sequence[Any], parts: Sequence[Any]) -> Mesh:
        """Mesh from ``points`` and blocks of ``cells``; in space if the points have three coordinates.

        ``points``: array of shape (nodes, 3), or (nodes, 2) in the plane, m. ``cells``: list of pairs (type, array of node
        numbers, one row per cell), or of objects with these as ``type`` and ``data``, such as the blocks of a mesh of meshio.
        ``parts``: list with an entry for each block; None leaves the block out.

        In space the part of "triangle" and "quad" is ``(material, thickness)`` of shells, with one thickness (m) or an array
        of one per cell; of "hexahedron" it is a `Material`; of "line" it is ``(material, section, orientation)`` as in
        `Mesh.add_space_beams`. In the plane the part of "quad" and "quad8" is a `Material`, of "quad8" also another material of
        `Mesh.add_quads`. Triangles match the
        sides that they share with quadrilaterals. Elements are numbered block by block, shells first. Other elements are
        added by the methods of the mesh.
        """
    def plot_shells(
        self,
        elements: Sequence[int],
        values: ArrayLike,
        *,
        quantity: str = "",
        view: Literal["plan", "front", "side", "space"] = "plan",
        axes: Axes | None = None,
        title: str | None = None,
    ) -> Axes:
        """Draws one value for each shell of a mat, wall or building, such as a bending moment; returns the axes.

        Colours are in classes on both sides of zero. The mean of a moment over the corners of a shell comes from
        `FemModel.shell_resultants`.

        Args:
            elements: numbers of the shells.
            values: array of shape (elements,), in the unit of the quantity.
            quantity: name of the values with their unit for the key, such as "m_x, kN·m/m"; empty by default.
            view: "plan" (by default) draws x and y of a mat; "front" x and height of a wall along x, "side" y and height of one
                along y; "space" all shells from the front, the right and above, near ones over far ones.
            axes: axes of matplotlib to draw into; unless given, axes of a new figure.
            title: text above the picture; none unless given.
        """
    def plot_solids(
        self,
        elements: Sequence[int],
        values: ArrayLike,
        *,
        quantity: str = "",
        axes: Axes | None = None,
        title: str | None = None,
    ) -> Axes:
        """Draws one value for each solid of a mesh in the plane, such as a plastic strain; returns the axes.

        Colours are in classes on both sides of zero. Solids without a value are drawn as their outlines, bars as lines.

        Args:
            elements: numbers of the quadrilaterals with a value, each once.
            values: array of shape (elements,), in the unit of the quantity.
            quantity: name of the values with their unit for the key, such as "plastic shear strain, %"; empty by default.
            axes: axes of matplotlib to draw into; unless given, axes of a new figure.
            title: text above the picture; none unless given.
        """
    def to_pyvista(
        self,
        values: Mapping[str, ArrayLike] | None = None,
        *,
        elements: Sequence[int] | None = None,
        units: Mapping[str, str] | None = None,
    ) -> UnstructuredGrid:
        """Elements of the mesh as a ``pyvista.UnstructuredGrid`` with values as cell data; it needs PyVista.

        In the plane z is zero. Cell data "element" has the numbers of the elements.

        Args:
            values: names and arrays of shape (elements,) or (elements, components), one row for each of ``elements``; none unless
                given.
            elements: numbers of the elements in the grid; all with two nodes or more unless given.
            units: unit of each of the values, stored in the field data "units" as texts "name: unit", in ASCII, such as
                "moment: N m/m"; none unless given.
        """

@final
class ShellResultants:
    """Forces and moments of a shell at a point, per metre of width.

    They refer to the `axes`. `FemModel.shell_resultants` and `ShellRows.value` return them.
    """

    @property
    def axes(self) -> NDArray[np.float64]:
        """Unit vectors e1, e2 and n, the normal of the element, as rows: array of shape (3, 3), numbers without unit."""
    @property
    def membrane(self) -> NDArray[np.float64]:
        """Membrane forces n_11, n_22 and n_12: array of shape (3,), N/m; tension is positive."""
    @property
    def moments(self) -> NDArray[np.float64]:
        """Moments m_11, m_22 and m_12: array of shape (3,), N·m/m; positive with tension on the side of −n."""
    @property
    def principal_moments(self) -> NDArray[np.float64]:
        """Larger and smaller principal moment: array of shape (2,), N·m/m."""
    @property
    def shears(self) -> NDArray[np.float64]:
        """Shear forces q_1 and q_2: array of shape (2,), N/m; on a section whose outward normal is e1 or e2, along n."""
    def in_axes(self, along: Sequence[float], outward: Sequence[float]) -> ShellResultants:
        """The same forces and moments in other axes: e1 is the part of the vector ``along`` in the plane of the element, n the
        normal on the side of the vector ``outward`` (x, y and z, of any length).
        """

@final
class ShellRows:
    """Rows of the forces and moments of shells at a node, for `Probe.section`.

    They are rows of displacements, per metre of width. `FemModel.shell_rows` returns them.

    A probe records changes from the static state; the static part is the `value` for the ``static_displacement`` of the
    simulation. The rows contain the elastic forces, without damping.
    """

    @property
    def node(self) -> int:
        """Number of the node."""
    @property
    def axes(self) -> NDArray[np.float64]:
        """Unit vectors e1, e2 and n as rows, means of the elements' axes: array of shape (3, 3), numbers without unit."""
    @property
    def membrane(self) -> list[SectionRows]:
        """Three `SectionRows` of the membrane forces n_11, n_22 and n_12, N/m; tension is positive."""
    @property
    def moments(self) -> list[SectionRows]:
        """Three `SectionRows` of the moments m_11, m_22 and m_12, N·m/m; positive with tension on the side of −n."""
    @property
    def shears(self) -> list[SectionRows]:
        """Two `SectionRows` of the shear forces q_1 and q_2, N/m."""
    def value(self, displacement: ArrayLike) -> ShellResultants:
        """The `ShellResultants` for all n degrees of freedom, ``displacement``: array of shape (n,), m and rad."""

@final
class Iwan:
    """Undrained clay, a material of solids in plane strain. It yields in shear only, along any concave backbone.

    Elastic–perfectly plastic components act in parallel (Iwan 1967, Besseling 1958), so that the stress in simple shear
    follows the backbone, and unloads and reloads by Masing's rules. The strength is the stress of the last point; it
    does not depend on the mean stress, which stays elastic. An initial stress must lie within the strength: with principal
    stresses σ_v and σ_h its √J₂ is |σ_v − σ_h|/√3 in plane strain with σ_z = σ_h.

    ``points``: array of shape (n, 2) of shear strain γ (engineering, 0.01 is 1 %) and shear stress τ (Pa) in simple
    shear, without the origin. The backbone is straight between points and constant beyond the last one. ``poisson``: Poisson's
    ratio ν of small strains; the bulk modulus is 2 G (1 + ν)/(3 (1 − 2ν)) with G = τ/γ of the first point. ``density``:
    kg/m³; 0 is allowed.
    """

    def __new__(cls, points: ArrayLike, poisson: float, density: float) -> Self: ...
    @staticmethod
    def hyperbolic(
        shear_modulus: float,
        strength: float,
        limit_strain: float,
        poisson: float,
        density: float,
    ) -> Iwan:
        """Soil with a hyperbolic backbone from its ``shear_modulus`` G of small strains (Pa) and its ``strength`` τ_s (Pa), which
        it reaches at the shear strain ``limit_strain`` γ_n; 200 τ_s/G is usual. ``poisson`` and ``density`` are as in the class.

        The backbone is τ = G γ/(1 + G γ/τ_m) with 1/τ_m = 1/τ_s − 1/(γ_n G), at 12 strains in a geometric series from
        0.02 τ_s/G to γ_n. Up to the first of them it is straight with the slope G. γ_n must be 5 τ_s/G or more.
        """
    @property
    def points(self) -> NDArray[np.float64]:
        """Points of the backbone: array of shape (n, 2) of shear strain and shear stress (Pa)."""
    @property
    def shear_modulus(self) -> float:
        """Shear modulus G of small strains, Pa."""
    @property
    def bulk_modulus(self) -> float:
        """Bulk modulus, Pa."""
    @property
    def strength(self) -> float:
        """Shear strength, Pa: the stress of the last point."""

@final
class DruckerPrager:
    """Sand or other drained soil, a material of solids in plane strain. It yields on Drucker–Prager's cone, which matches
    Mohr–Coulomb's law in plane strain.

    It is elastic–perfectly plastic, with a ``cohesion`` c (Pa), a ``friction_angle`` φ and a ``dilation_angle`` ψ
    (rad), 0 ≤ ψ ≤ φ < π/2; ``elastic`` is its `Material`. A smaller ψ than φ makes the tangent unsymmetric, and steps
    take longer. Stress beyond the tip of the cone returns to the tip. With φ = 0 it is von Mises' law with the shear
    strength c, and with ψ = 0 the plastic strain has no change of volume.

    An initial stress must lie within the cone. Without cohesion the stress at rest with σ_h = (1 − sin φ) σ_v lies
    outside the cone for φ above about 36°; and without an initial stress a soil without cohesion has no strength.
    """

    def __new__(
        cls,
        elastic: Material,
        cohesion: float,
        friction_angle: float,
        dilation_angle: float,
    ) -> Self: ...
    @property
    def cohesion(self) -> float:
        """Cohesion c, Pa."""
    @property
    def friction_angle(self) -> float:
        """Friction angle φ, rad."""
    @property
    def dilation_angle(self) -> float:
        """Dilation angle ψ, rad."""

@final
class SolidPoints:
    """States at the n integration points of an element whose material yields or is a `UserMaterial`.

    `Simulation.solid_points` and `FemModel.solid_points` return them. Components are xx, yy, zz and xy; tension is
    positive, and the shear strain is the engineering strain. The values include the static state.
    """

    @property
    def element(self) -> int:
        """Number of the element."""
    @property
    def position(self) -> NDArray[np.float64]:
        """Positions x and y in the undeformed mesh: array of shape (n, 2), m."""
    @property
    def area(self) -> NDArray[np.float64]:
        """Area of each point, the factor of its values in integrals over the element: array of shape (n,), m²."""
    @property
    def strain(self) -> NDArray[np.float64]:
        """Strains: array of shape (n, 4), numbers without unit."""
    @property
    def stress(self) -> NDArray[np.float64]:
        """Stresses: array of shape (n, 4), Pa."""
    @property
    def plastic_strain(self) -> NDArray[np.float64]:
        """Plastic shear strains √(2 e^p : e^p) of the deviator e^p, in simple shear |γ^p|: array of shape (n,), numbers without
        unit.
        """
    @property
    def mobilised_strength(self) -> NDArray[np.float64]:
        """Ratio of shear stress to shear strength at each point, from 0 to 1: array of shape (n,)."""
    @property
    def mean_plastic_strain(self) -> float:
        """Plastic shear strain, mean over the area of the element; a number without unit."""
    @property
    def largest_mobilised_strength(self) -> float:
        """Largest ratio of shear stress to shear strength at the points."""

@final
class StressAtRest:
    """Stresses of level soil at rest: its weight, and K₀ times its weight sideways.

    The vertical pressure at a depth is the weight of all soil above; the horizontal pressure is K₀ times as large in both
    horizontal directions, without shear. The surface is at y = 0, and y points up. `Mesh.with_stress_at_rest` makes
    elements begin with these stresses, `SoilProfile.stress_at_rest` has those of a profile. For sand with drainage below
    the water table, take the density under buoyancy: the stresses are those of the grains.

    ``gravity``: m/s². ``density``: kg/m³. ``ratio``: K₀, the horizontal over the vertical pressure.
    """

    def __new__(cls, gravity: float, density: float, ratio: float) -> Self: ...
    def with_soil_below(self, depth: float, density: float, ratio: float) -> StressAtRest:
        """These stresses with other soil below a ``depth`` (m), of a ``density`` (kg/m³) and a ``ratio`` K₀. The depth lies below
        the upper ends of all layers so far.
        """
    def at(self, positions: ArrayLike) -> NDArray[np.float64]:
        """Stresses at ``positions``: array of shape (n, 4) of xx, yy, zz and xy, Pa. Tension is positive, and zero above the
        surface. ``positions``: array of shape (n, 2), x and y, m.
        """

@final
class WithElements(Structure):
    """A linear ``structure`` with the elements of a ``mesh`` that yield, such as beams of fibres.

    The structure may be a `MatrixModel` of another program. ``rows``: a list for each node of the mesh, of the rows of its
    displacements in the directions of the mesh ("x", "y" and "rotation" in the plane; six in space) as sums of degrees of
    freedom of the structure. The elements add their forces and masses; their stiffness must not be in the matrix of the
    structure, and Rayleigh damping by their stiffness is not added. `Simulation.beam_sections` and `Simulation.solid_points`
    return their states, by their numbers in the mesh. `WithSprings` may be around it, not inside.
    """

    def __new__(cls, structure: _Structure, mesh: Mesh, rows: Sequence[Sequence[_RowLike]]) -> Self: ...

@final
class Condition:
    """One linear condition on an element at the end of a step:
    ``gap`` · g + ``slip`` · s + ``pressure`` · p + ``shear`` · τ = ``value``, with its gap g and slip s (m),
    pressure p and shear traction τ (Pa). Each coefficient is 0 by default.
    """

    def __new__(
        cls,
        *,
        gap: float = 0.0,
        slip: float = 0.0,
        pressure: float = 0.0,
        shear: float = 0.0,
        value: float = 0.0,
    ) -> Self: ...
    @staticmethod
    def gap_is(value: float) -> Condition:
        """The gap is ``value``, m."""
    @staticmethod
    def slip_is(value: float) -> Condition:
        """The slip is ``value``, m."""
    @staticmethod
    def pressure_is(value: float) -> Condition:
        """The pressure is ``value``, Pa."""
    @staticmethod
    def shear_is(value: float) -> Condition:
        """The shear traction is ``value``, Pa."""
    @property
    def gap(self) -> float:
        """Coefficient of the gap."""
    @property
    def slip(self) -> float:
        """Coefficient of the slip."""
    @property
    def pressure(self) -> float:
        """Coefficient of the pressure."""
    @property
    def shear(self) -> float:
        """Coefficient of the shear traction."""
    @property
    def value(self) -> float:
        """Right-hand side; in m or Pa if the coefficients have no unit."""

@final
class Tolerance:
    """Differences below which a law treats numbers as equal: ``length`` for gaps and slips (m), ``traction`` for pressure
    and shear (Pa).
    """

    def __new__(cls, length: float, traction: float) -> Self: ...
    @property
    def length(self) -> float:
        """Difference of gaps and slips, m."""
    @property
    def traction(self) -> float:
        """Difference of tractions, Pa."""

@disjoint_base
class ContactState:
    """Gap, slip and tractions of an element: ``gap`` (positive when open) and ``slip`` (m), ``pressure`` (positive in
    compression) and ``shear`` (Pa); in plan also ``slip_across`` (m) and ``shear_across`` (Pa) along y. All are 0 by
    default.
    """

    def __new__(
        cls,
        *,
        gap: float = 0.0,
        slip: float = 0.0,
        pressure: float = 0.0,
        shear: float = 0.0,
        slip_across: float = 0.0,
        shear_across: float = 0.0,
    ) -> Self: ...
    @property
    def gap(self) -> float:
        """Gap, m; positive when open."""
    @property
    def slip(self) -> float:
        """Slip since the static state, m; positive to the right."""
    @property
    def pressure(self) -> float:
        """Pressure, Pa; positive in compression."""
    @property
    def shear(self) -> float:
        """Shear traction of the structure on the soil, Pa; positive to the right."""
    @property
    def slip_across(self) -> float:
        """Slip along y in plan, m; positive away."""
    @property
    def shear_across(self) -> float:
        """Shear traction of the structure on the soil along y in plan, Pa; positive away."""

@final
class PreviousContact(ContactState):
    """An element at the start of a step: its `ContactState` and its history.

    To try a law without a simulation, create one from a ``state`` (`ContactState`), its ``mode``, the ``time_step``
    (s), the ``slip_rate`` (m/s; 0 by default), the ``trial_settlement`` (m; 0 by default) and the law's
    ``state_variables`` (array of shape (m,); none unless given).
    """

    def __new__(
        cls,
        state: ContactState,
        mode: Mode,
        time_step: float,
        *,
        slip_rate: float = 0.0,
        trial_settlement: float = 0.0,
        state_variables: ArrayLike | None = None,
    ) -> Self: ...
    @property
    def mode(self) -> Mode:
        """Mode of the step before, as in `basemat.MODES`."""
    @property
    def has_opened(self) -> bool:
        """Whether the element was open at any time before."""
    @property
    def slip_rate(self) -> float:
        """Slip rate of the step before, m/s; its magnitude in plan."""
    @property
    def static_pressure(self) -> float:
        """Pressure of the static state, Pa."""
    @property
    def time_step(self) -> float:
        """Time step, s."""
    @property
    def trial_settlement(self) -> float:
        """Settlement of the yielding soil in the present trial of the step, m; 0 in its first trial.

        A law whose pressure is a curve over the settlement returns the tangent of the curve at this settlement, as
        ``pressure_cap`` and ``hardening`` of its `Limits`; the step is solved again until the pressure is on the curve.
        """
    @property
    def state_variables(self) -> list[float]:
        """State variables of the law: list of numbers."""

@final
class Limits:
    """Limits of an element's tractions in the step that begins with a `PreviousContact`: what `UserPlanLaw.limits`
    returns.

    The pressure p (Pa) is between −``tension`` (0 by default) and ``pressure_cap`` (``math.inf`` by default: no bound),
    which grows by ``hardening`` (Pa/m; 0 by default) with the settlement of yielding soil in the step. The shear
    traction is at most ``friction`` (0 by default; ``math.inf`` where nothing slides) · max(p + ``attraction``, 0) +
    ``shear_strength`` (Pa, both 0 by default), and slip is in its direction. ``gap_offset`` (m; 0 by default): gap of a
    closed element, ``-math.inf`` for an element that cannot close in this step. ``bonded`` (False by default): whether
    base and soil neither separate nor slide. An element that has opened with a tension, an attraction or a shear
    strength loses them in that step.
    """

    def __new__(
        cls,
        friction: float = 0.0,
        *,
        attraction: float = 0.0,
        shear_strength: float = 0.0,
        tension: float = 0.0,
        pressure_cap: float = 1e999,
        hardening: float = 0.0,
        gap_offset: float = 0.0,
        bonded: bool = False,
    ) -> Self: ...
    @property
    def friction(self) -> float:
        """Friction coefficient; infinite where nothing slides."""
    @property
    def attraction(self) -> float:
        """Pressure that friction acts on in addition to the contact pressure, Pa."""
    @property
    def shear_strength(self) -> float:
        """Shear strength in addition to friction, Pa."""
    @property
    def tension(self) -> float:
        """Tensile strength, Pa."""
    @property
    def pressure_cap(self) -> float:
        """Largest pressure of soil that does not settle in the step, Pa."""
    @property
    def hardening(self) -> float:
        """Growth of the largest pressure with the settlement in the step, Pa/m."""
    @property
    def gap_offset(self) -> float:
        """Gap of a closed element, m."""
    @property
    def bonded(self) -> bool:
        """Whether base and soil neither separate nor slide."""
    def __eq__(self, value: object, /) -> bool: ...

def memory_limit() -> int:
    """Largest memory of one mesh, matrix, ground, record or sweep, bytes: 8 GiB. The needed memory is compared with this
    limit before it is allocated; the error states the needed memory.
    """

def set_memory_limit(bytes: int) -> None:
    """Deprecated: warns and has no effect, since the `memory_limit` is fixed. ``bytes`` is ignored."""

def _case_numbers(grid: Sequence[tuple[str, Any]], shard: tuple[int, int] | None = None) -> list[int]: ...

def _merge_cases(
    paths: Sequence[str | os.PathLike[str]],
    grid: Sequence[tuple[str, Any]],
) -> tuple[list[str], list[tuple[int, list[float] | None, str | None, str | None]]]: ...

def _collect_warnings(collect: bool) -> list[str]: ...

def mean_coherence(coherence: Coherence, frequency: float, ground: Ground) -> NDArray[np.float64]:
    """Coherence between the means of the motion over the contact elements of a ``ground``: array of shape (elements, elements),
    ratios.

    It is the mean of the ``coherence`` (`Coherence`) at a ``frequency`` (Hz) over all pairs of points in two elements.
    """

def free_field(
    *,
    displacement: Callable[[float, float], float | Sequence[float]] | None = None,
    acceleration: Callable[[float], float | Sequence[float]] | None = None,
    time_step: float | None = None,
    duration: float | None = None,
    displacement_at: Callable[[float, float, float], Sequence[float]] | None = None,
) -> FreeField:
    """A motion that one function defines: give ``displacement``, ``acceleration`` or ``displacement_at``.

    ``displacement``: a function ``(x, time) -> (right, up)`` of the surface's displacement in m, at x (m) and time (s,
    above 0). It should begin with zero: until t = 0 the ground is at rest.

    ``acceleration``: a function ``(time) -> (right, up)`` in m/s², the same everywhere. It is sampled every
    ``time_step`` (s) from 0 to ``duration`` (s), linear between the samples as a `Record`, and integrated exactly from
    rest. After the ``duration`` it is zero, and the velocity stays constant.

    ``displacement_at``: for a ground in plan, a function ``(x, y, time) -> (along x, along y, up)`` of the displacement in m at
    the point x, y (m).

    ``displacement`` and ``acceleration`` may instead return one number, the motion to the right. All three functions
    may raise an exception. Arguments that are not given are None.
    """

def el_centro_1940() -> Record:
    """The `Record` of El Centro 1940, north–south.

    Peknold's version with a peak of 0.319 g: 31.18 s with a time step of 0.02 s.
    """

def log_spaced(first: float, last: float, count: int) -> NDArray[np.float64]:
    """``count`` numbers from ``first`` to ``last`` with equal ratios, such as periods: array of shape (count,)."""

def vertical_incidence(horizontal: Record | None = None, vertical: Record | None = None) -> FreeField:
    """Motion of a ``horizontal`` `Record` (to the right), of a ``vertical`` one (up), or of both, the same everywhere; a
    component is zero unless given.
    """

def triaxial(x: Record | None = None, y: Record | None = None, up: Record | None = None) -> FreeField:
    """Motion of records along ``x`` (to the right), ``y`` (away) and ``up`` (each a `Record`), the same everywhere, for a
    ground in plan; a component is zero unless given.
    """

def travelling_wave(
    motion: FreeField,
    apparent_velocity: float,
    origin: float,
    *,
    azimuth: float = 0.0,
) -> FreeField:
    """A ``motion`` (`FreeField`) that travels along x with an ``apparent_velocity`` (m/s; to the left if negative) and
    acts unchanged at the ``origin`` (x, m). ``azimuth`` (rad; 0 by default): in plan the direction of travel, along
    which ``origin`` is measured, counter-clockwise from x as seen from above; the components of the motion turn with
    it.
    """

def ricker(amplitude: float, sigma: float, center: float, *, vertical: bool = False) -> FreeField:
    """Ricker pulse of displacement to the right, or up if ``vertical`` (False by default): ``amplitude`` of the peak (m),
    width ``sigma`` (s), time ``center`` (s).
    """

def _restored(kind: str, data: bytes) -> Any: ...

@overload
def refine(
    elements: int,
    time_step: float,
    scene: Callable[[int, float], Mapping[str, float]],
) -> Refinements:
    """Runs a scene at six settings and estimates the error of each.

    The estimate is Richardson's extrapolation. ``scene(elements, time_step)`` builds and runs a simulation, and returns
    a number or an array: a peak, some peaks, or a time series at times that all settings have (the times of the
    coarsest setting). The settings are: ``elements`` and ``time_step`` (s); half and a quarter of the step; two and
    four times the elements; twice the elements with half the step.

    If the scene returns a dict of numbers by names, such as several peaks, the result is `Refinements`: each number is
    extrapolated separately, so that units may differ.

    Even a regular estimate may be too low if the base slides or opens: for a sliding block it was too low by a factor
    of 2.4 at one of the six settings. On layers the number of stages of the convolution quadrature depends on the error
    at 15 Hz and may change between the settings; ``stages`` of `ElasticGround` fixes it.
    """
@overload
def refine(elements: int, time_step: float, scene: Callable[[int, float], float | ArrayLike]) -> Refinement:
    """Runs a scene at six settings and estimates the error of each.

    The estimate is Richardson's extrapolation. ``scene(elements, time_step)`` builds and runs a simulation, and returns
    a number or an array: a peak, some peaks, or a time series at times that all settings have (the times of the
    coarsest setting). The settings are: ``elements`` and ``time_step`` (s); half and a quarter of the step; two and
    four times the elements; twice the elements with half the step.

    If the scene returns a dict of numbers by names, such as several peaks, the result is `Refinements`: each number is
    extrapolated separately, so that units may differ.

    Even a regular estimate may be too low if the base slides or opens: for a sliding block it was too low by a factor
    of 2.4 at one of the six settings. On layers the number of stages of the convolution quadrature depends on the error
    at 15 Hz and may change between the settings; ``stages`` of `ElasticGround` fixes it.
    """

def sensitivity(
    elements: int,
    time_step: float,
    scene: Callable[[int, float], Mapping[str, float]],
) -> Sensitivity:
    """Runs a scene and three twins of it, and compares their peaks: with a time step shorter by 1 %, and on three quarters
    and half of the elements.

    ``scene(elements, time_step)`` builds a simulation and runs it for a duration, and returns a dict of peaks by their
    names. The motion of a body that rocks on its corners may be chaotic: its peaks then belong to one motion out of
    many, and no finer setting makes them converge. The twins show how many digits of a peak can be quoted, and take
    less time than two further runs.
    """

def _joint_results(run: Run, joint: int) -> JointResults: ...

def equivalent_damping(rotation: ArrayLike, moment: ArrayLike) -> float:
    """Equivalent viscous damping ratio E/(2π M θ) of one measured cycle of moments over rotations.

    E is the area of the polygon of the measured points, M and θ are half the ranges (Gajan and Kutter 2008). An
    `InputError` is raised if the points are not one closed cycle. `Run.equivalent_damping` computes the ratio from a
    run.

    Args:
        rotation: rotations, array of shape (m,), rad.
        moment: moments in any unit, array of shape (m,).
    """

def fiber_stress_path(material: _FiberLaw, strains: ArrayLike) -> NDArray[np.float64]:
    """Stresses at the ``strains`` of a path through a law of fibres, which starts without strain: array of shape (n,), Pa.

    ``material``: a `Concrete`, `BilinearSteel`, `MenegottoPinto`, `Material` or `UserUniaxialMaterial`. ``strains``: array of
    shape (n,), tension positive; every state is committed.
    """

def stress_path(
    material: _Solid,
    strains: ArrayLike,
    *,
    initial_stress: Sequence[float] | None = None,
) -> NDArray[np.float64]:
    """Stresses at the ``strains`` of a path through a ``material`` of solids, which starts without strain: array of shape
    (n, 4), Pa.

    ``material``: a `Material`, `Iwan`, `DruckerPrager` or `UserMaterial`. ``strains``: array of shape (n, 4) of xx, yy, zz
    and xy, with the engineering shear strain; every state is committed. ``initial_stress``: stress at zero strain, xx, yy, zz
    and xy (four numbers, Pa; tension is positive); none unless given.
    """

def _cancel_when(event: Any = None) -> None: ...
