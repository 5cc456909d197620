"""The records that describe a group of like elements, a model in a state and its unknowns to compiled code.

Elements are processed in batches, nodes in chunks, of at most `LANES`. Each quantity of a batch is a row of `ROW`
numbers, one per element, so that loops along rows use vector instructions. Nodes are stored in chunks of such rows.
"""

from typing import Annotated

from beamfem.kernels.compiler.value_types import signature_of
from beamfem.kernels.records import Reals, Record, Several, Slots, Table, Wholes, calls

CONSTANTS = 4  # of a station
LANES = 64
ROW = 72  # longer than a batch, so that rows do not all map to the same cache sets
# of passes derived in `physics`: over rows of points or nodes, and forces and tangents of parts at points and stations
ROWS_PASS, CONVECT_PASS = signature_of("iv"), signature_of("iddv")
USER_LAW = signature_of("rrdrrr")  # of strain, history, dt, data, resultants and tangent
POINT_FORCE = signature_of("rrrrrrrr")  # of q, v, a, own, turned, data, gravity and the result
POINT_ROOT = signature_of("rrdr")  # of q, data, xi and the result: h, -dh/dxi, size and scale
POINT_TANGENT = signature_of("rrrrrrrdddr")  # likewise, with ck, cv and ca before the result


class Run(Record):
    """Consecutive nodes of one kind."""

    node_kind: int
    first: int
    length: int


class NodePasses(Record):
    """The compiled functions of a kind of node with an angle."""

    place = calls(ROWS_PASS, "forces")
    convect = calls(CONVECT_PASS, "mass")
    curve = calls(ROWS_PASS, "tangent")


class GroupRoutines(Record):
    """The compiled functions of a group, each set when a task first needs it; nodes: by kind of node, less one."""

    nodes: Table[NodePasses]
    collect = calls("gathering:collect", "forces")
    scatter = calls("gathering:scatter", "forces")
    interpolate = calls("field:interpolate", "forces")
    distribute = calls("field:distribute", "forces")
    columns = calls("element_stiffness:columns", "tangent")
    products = calls("element_stiffness:products", "tangent")
    mirror = calls("element_stiffness:mirror", "tangent")
    combine = calls("element_stiffness:combine", "rotation tangent", "rotation station tangent")
    store = calls("element_stiffness:store", "tangent")
    add_inertia = calls("inertia_forces:add_inertia", "forces")
    add_mass = calls("inertia_forces:add_mass", "mass")
    add_scaled = calls("inertia_forces:add_scaled", "mass")
    reduce_rows = calls("reduction:reduce_rows", "rotation station tangent")
    add_to_sparse = calls("reduction:add_to_sparse", "sparse")
    add_curvature = calls("reduction:add_curvature", "rotation tangent")
    add_to_band = calls("band_assembly:add_to_band", "band")
    rotate_frame = calls("nodes:rotate_frame", "angles")
    rotate = calls("nodes:rotate", "rotated")
    copy_rows = calls("nodes:copy_rows", "forces")
    clear = calls("nodes:clear", "forces")
    strains = calls(ROWS_PASS, "forces")
    forces = calls(ROWS_PASS, "forces")
    rates = calls(ROWS_PASS, "prediction", "damping")
    hessian = calls(ROWS_PASS, "tangent")
    law = calls("linear_law:four_resultants", "forces")
    add_viscous = calls("linear_law:add_viscous", "damping")
    rate_changes = calls(ROWS_PASS, "damping tangent")
    add_component = calls("rate_tangent:add_component", "damping tangent")
    add_products = calls("rate_tangent:add_products", "damping tangent")
    add_rate_tangent = calls("rate_tangent:add_rate_tangent", "damping tangent")
    release = calls("linear_law:release", "imposed")
    add_stations = calls("station_passes:add_stations", "stations")
    station_forces = calls("station_passes:station_forces", "stations")
    place_nodes = calls("node_passes:place_nodes", "forces")
    finish_nodes = calls("node_passes:finish_nodes", "forces")
    add_elements = calls("element_passes:add_elements", "forces")
    form_matrices = calls("element_matrices:form_matrices", "tangent")
    add_matrices = calls("element_matrices:add_matrices", "tangent")
    reduce_and_add = calls("element_matrices:reduce_and_add", "station tangent")
    rate_nodes = calls("model_passes:rate_nodes", "prediction", "damping")
    turn_nodes = calls("model_passes:turn_nodes", "damping tangent")


class StationPasses(Record):
    """The compiled functions of a kind of station."""

    force = calls(POINT_FORCE)
    tangent = calls(POINT_TANGENT)


class Group(Record):
    """A group of like elements."""

    elements: int
    nodes: int
    nodes_per_element: int
    vectors: int  # nodal vectors per node
    points: int  # quadrature points
    measures: int  # strain measures
    dependent: int  # number of components of nodal vectors, the last ones, that are not coordinates but w(u): 0, 2 or 4
    parameters: int  # number of coordinates u, the last ones, on which they depend
    coordinates: int  # per node, at most
    bends: int  # whether the third vector of strain measures is r0''
    batch: int  # elements in a batch
    routines: GroupRoutines

    # first row of each table of a class of elements, and the number of rows
    slope: int  # (points, slots)
    second: int  # (points, slots), none unless it bends
    stiffness: int  # (points, measures (measures + 1) / 2) upper triangle
    reference: int  # (points, measures)
    weight: int  # (points,)
    mass: int  # (slots, slots)
    gravity: int  # (slots,)
    length: int  # (slots,)
    damping: int  # (1,) retardation time [s], if it is damped
    table_rows: int
    tables: Reals  # (classes, table rows)

    damped: int  # whether resultants depend on strain rates
    mass_damping: float  # [1/s]: a = p'' + this p' takes the place of p''
    slowed: Reals  # (n,) a, if it is not 0
    apart: int  # whether the mass does not couple d with r0
    ordered: int  # whether each node of an element has a greater number than the same node of the element before
    director: Annotated[Reals, "points", "nodes_per_element"]
    classes: Annotated[Wholes, "elements"]
    beam: Annotated[Wholes, "elements"]
    place: Annotated[Wholes, "nodes_per_element", "elements"]  # offset of the node's first entry in the chunks
    dof: Annotated[Wholes, "coordinates", "nodes"]
    source: Wholes  # (coordinates, nodes), padded: as `dof` with 0 for -1, so that lanes can be read blindly
    frame: Reals  # (3, nodes), padded
    run_count: int
    runs: Annotated[Several, Run]  # (runs, 3)
    number: Wholes  # (nodes of an element * coordinates, elements): number among the unknowns, or -1
    slot: Slots  # (elements, coordinates, coordinates): positions in the data of a sparse matrix
    half_width: int  # half-bandwidth, -1 for a sparse matrix
    free: Wholes  # (n,): number of a coordinate among the unknowns
    home: Annotated[Wholes, "nodes", 2]  # an element that contains the node, and the node's number in that element
    counted: Wholes  # (elements,): 0, 1, 2, ..., for a sparse matrix
    law_points: int  # quadrature points where a law with history acts
    variables: int
    history: Annotated[Wholes, "elements", "law_points", "variables"]  # coordinates that are history variables of a law
    law_acts: int  # quadrature points where a user's law in C acts, see `user_law`
    thickens: int  # whether thickness stretch is resisted beside it
    law_data: Reals
    user_law = calls(USER_LAW)
    natural: Reals  # (elements, points, measures): strains imposed by loads, if there are any
    natural_of_steps: Reals  # (steps or 1, elements, points, measures): those of the steps of a motion

    # rows of a node, after its nodal vectors e
    acceleration: int  # e''
    transform: int  # B (dependent, parameters)
    convective: int  # derivatives of e'' with respect to p and p' (dependent, parameters)
    velocity: int  # e', if resultants depend on it
    turning: int  # B' (dependent, parameters), likewise
    curvature: int  # derivative of B^T f (parameters, parameters)
    force: int
    predicted_force: int  # the same with the stress resultants predicted by the last correction
    node_rows: int

    # workspace
    chunk_count: int
    chunks: Annotated[Reals, "chunk_count", "node_rows", ROW]
    stress: Annotated[Reals, "elements", "points", "measures"]
    space_rows: int
    space: Annotated[Reals, "space_rows", ROW]  # workspace of a batch, laid out by `batch`
    filled_class: int  # the class whose tables are in the workspace, or -1 - the first of several elements
    filled_count: int  # number of these elements

    # forces at stations of elements
    stations: int
    station_element: Annotated[Wholes, "stations"]
    station_kind: Annotated[Wholes, "stations"]
    kinds: Table[StationPasses]
    position: Reals  # (slots, stations)
    direction: Reals  # (slots, stations)
    constants: Annotated[Reals, "stations", CONSTANTS]
    station_place: Annotated[Wholes, "nodes_per_element", "stations"]
    station_number: Wholes  # (nodes * coordinates, stations)
    values: Reals  # (stations, 3): forces and moments [N, N, N m]
    values_of_steps: Reals  # (steps or 1, stations, 3): those of the steps of a motion


class Parts(Record):
    """Parts at points of one kind, see `connection_passes`."""

    count: int
    alternatives: int  # of a part: rows of the tables, of which it has one at a time
    rows: int  # count * alternatives
    position_step: int  # where there is a root: of points, from one that is a position to the next
    coordinates: int  # of a part
    rotations: int  # of its points
    multipliers: int
    unknowns: int  # coordinates, multipliers and prescribed values
    numbers: Annotated[Wholes, "rows", "unknowns"]
    data_size: int
    data: Annotated[Reals, "rows", "data_size"]
    history_size: int
    history: Annotated[Wholes, "count", "history_size"]  # coordinates that are its history variables
    places: Annotated[Wholes, "rows", "unknowns", "unknowns"]  # of the tangent's entries in the matrix, -1 for none
    add = calls("connection_passes:add_parts")  # or a function in Python
    force = calls(POINT_FORCE)
    tangent = calls(POINT_TANGENT)
    root = calls(POINT_ROOT)
    remember = calls(POINT_FORCE)  # of parts with history
    commit = calls("connection_passes:commit")  # likewise


class System(Record):
    """A model in a state p, p', p'', and what it is asked for."""

    group_count: int
    groups: Table[Group]
    size: int
    p: Annotated[Reals, "size"]
    v: Annotated[Reals, "size"]
    a: Annotated[Reals, "size"]
    body: Reals  # (beams, 4)
    residual: Annotated[Reals, "size"]
    entries: int
    matrix: Annotated[Reals, "entries"]
    weight_p: float  # ck, cv, ca: weights of p, p' and p'' in the tangent
    weight_v: float
    weight_a: float
    time: float  # [s], in statics the load factor
    since_committed: float  # [s] from the committed history
    tangent: int  # whether it is needed
    predicted: int  # whether the geometric part of the tangent uses the resultants in `stress`
    moving: int
    rated: int  # whether strain rates matter
    loaded: int
    part_kinds: int
    parts: Table[Parts]


class Border(Record):
    """A band (n, n) and the entries beside it, see `condensation`: of t unknowns, and of k multipliers behind it."""

    unknown: int  # n
    half: int
    rows: Reals  # (n, 2 half + 1)
    reach: Slots
    edge: int  # t
    numbers: Annotated[Wholes, "edge"]
    conditions: int  # k
    entries: Reals  # (t + k, t + k)
    negative: int  # eigenvalues for motions that satisfy the conditions
    signs: Annotated[Reals, "unknown"]
    columns: Annotated[Reals, "edge", "unknown"]
    beside: Reals  # (t, 2 half + 1)
    condensed: Reals  # (t + k, t + k)
    sizes: Reals  # (3, t + k)
    factor = calls("bidirectional_lu:ANY.factor")
    solve = calls("bidirectional_lu:ANY.solve")


class Solver(Record):
    """The unknown coordinates and the linear equations for them, which are a band."""

    size: int
    unknown: int
    free_dofs: Annotated[Wholes, "unknown"]
    first_free: int  # number of the first unknown coordinate if all have consecutive numbers, else -1
    half: int
    width: int  # 2 half + 1
    rollers: int
    roller_first: Annotated[Wholes, "rollers"]  # number of the x of each among the unknowns
    roller_normal: Annotated[Reals, "rollers", 2]
    rows: Reals  # (unknown, width), or the entries of a sparse matrix
    right: Annotated[Reals, "unknown"]
    step: Reals  # (n,), for motions (n + 2,): with the last two rates of convergence
    scale: Annotated[Reals, "size"]
    inverse_scale: Reals  # (n,), for motions padded
    reach: Slots  # (2, unknown): see `band.elimination`, downwards and backwards
    bordered: int  # whether the band has a border
    border: Border
