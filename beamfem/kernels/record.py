"""Layout of the tables of integers and addresses that describe a group of like elements, or a model, to compiled code.

Python owns all arrays that addresses point to, and checks them once, when it makes a table (`assembly.element_group`).

Elements are processed in batches, nodes in chunks, of at most `LANES`. Each quantity of a batch is a row of `ROW`
numbers, one per element, so that loops along rows use vector instructions. Nodes are stored in chunks of such rows.
"""

LANES = 64
ROW = 72  # longer than a batch, so that rows do not all map to the same cache sets

# ------------------------------------------------------------------ a group of like elements
ELEMENTS = 0
NODES = 1
NODES_PER_ELEMENT = 2
VECTORS = 3  # nodal vectors per node
POINTS = 4  # quadrature points
MEASURES = 5  # strain measures
DEPENDENT = 6  # number of components of nodal vectors, the last ones, that are not coordinates but w(u): 0, 2 or 4
PARAMETERS = 7  # number of coordinates u, the last ones, on which they depend
BENDS = 8  # whether the third vector of strain measures is r0''
BATCH = 9  # elements in a batch
# rows of a class of elements: first row of each table, and the number of rows
SLOPE = 10  # (points, slots)
SECOND = 11  # (points, slots)
STIFFNESS = 12  # (points, measures (measures + 1) / 2) upper triangle
REFERENCE = 13  # (points, measures)
WEIGHT = 14  # (points,)
MASS = 15  # (slots, slots)
GRAVITY = 16  # (slots,)
LENGTH = 17  # (slots,)
TABLE_ROWS = 18
TABLES = 19  # address (classes, table rows)
DIRECTOR = 20  # address (points, nodes of an element)
CLASS = 21  # address (elements,)
BEAM = 22  # address (elements,)
PLACE = 23  # address (nodes of an element, elements): offset of the node's first entry in the chunks
DOF = 24  # address (coordinates of a node, nodes)
FRAME = 25  # address (3, nodes)
RUNS = 26  # address (runs, run fields): nodes of one kind, see RUN_KIND
RUN_COUNT = 27
NUMBER = 28  # address (nodes of an element * coordinates of a node, elements): number among the unknowns, or -1
SLOT = 29  # address (elements, coordinates, coordinates): positions in the data of a sparse matrix
HALF_WIDTH = 30  # half-bandwidth, -1 for a sparse matrix
FREE = 31  # address (n,): number of a coordinate among the unknowns
HOME = 32  # address (nodes, 2): an element that contains the node, and the node's number in that element
COORDINATES = 33  # per node, at most
# rows of a node, after its nodal vectors
ACCELERATION = 34
TRANSFORM = 35  # B (dependent, parameters)
CONVECTIVE = 36  # derivatives of e'' with respect to p and p' (dependent, parameters)
CURVATURE = 37  # derivative of B^T f (parameters, parameters)
FORCE = 38
PREDICTED_FORCE = 39  # the same with the stress resultants predicted by the last correction
NODE_ROWS = 40
# workspace
CHUNKS = 41  # address (chunks, node rows, ROW)
STRESS = 42  # address (elements, points, measures)
SPACE = 43  # address: workspace of a batch, laid out by `batch`
# forces, moments and springs at points
LOADS = 44
LOAD_ELEMENT = 45
POSITION = 46  # address (slots, loads)
DIRECTION = 47
FOLLOWS = 48  # (2, loads)
STRETCHES = 49
SPRING = 50  # (2, loads)
ANCHOR = 51  # (2, loads)
LOAD_PLACE = 52  # (nodes of an element, loads)
LOAD_NUMBER = 53  # (nodes * coordinates, loads)
FILLED = 54  # address (3,): tables, class or elements that are in the workspace, and the number of elements
ROUTINES = 55  # address of a table of compiled functions
COUNTED = 56  # address (elements,): 0, 1, 2, ...
DAMPED = 57  # whether resultants depend on strain rates
DAMPING = 58  # rows of a class: (1,) retardation time [s]
VELOCITY = 59  # rows of a node: e', if resultants depend on it
APART = 60  # whether the mass does not couple d with r0
NATURAL = 61  # address (elements, points, measures): strains imposed by loads; 0 if there are none
ORDERED = 62  # whether each node of an element has a greater number than the same node of the element before
SOURCE = 63  # address (coordinates of a node, nodes), padded: as DOF with 0 for -1, so that lanes can be read blindly
HISTORY = 64  # address (elements, points of the law, k): coordinates that are history variables of a law
VARIABLES = 65  # k
BLOCK_FIELDS = 66

RUN_KIND, RUN_FIRST, RUN_LENGTH = range(3)
RUN_FIELDS = 3

# ------------------------------------------------------------------ a model in a state
GROUPS = 0
GROUP_RECORDS = 1  # address of a table of addresses
COORDINATES_P = 2  # p, p', p'' (n,)
COORDINATES_V = 3
COORDINATES_A = 4
BODY = 5  # (beams, 4)
VALUES = 6  # address of a table of addresses (loads, 3), of each group
RESIDUAL = 7
SIZE = 8
MATRIX = 9
ENTRIES = 10
FACTORS = 11  # see WEIGHT_P
TANGENT = 12
PREDICTED = 13  # whether the geometric part of the tangent uses the resultants in `STRESS`
MOVING = 14
LOADED = 15
SPRINGS = 16
SPRING_DOF = 17
SPRING_STIFFNESS = 18
SPRING_REST = 19
SPRING_PLACE = 20
RATED = 21  # whether strain rates matter
CONNECTIONS = 22  # number of kinds of parts at points, see `connection_passes`
CONNECTION_TABLES = 23  # address (kinds, fields)
ADD_CONNECTIONS = 24  # address of their routine
SYSTEM_FIELDS = 25

WEIGHT_P, WEIGHT_V, WEIGHT_A = range(3)  # ck, cv, ca: weights of p, p' and p'' in the tangent
SINCE_COMMITTED = 3  # [s] from the committed history
FACTOR_COUNT = 4

# ------------------------------------------------------------------ compiled functions, by their number in `ROUTINES`
(
    COLLECT,
    SCATTER,
    INTERPOLATE,
    DISTRIBUTE,
    COLUMNS,
    PRODUCTS,
    MIRROR,
    ADD_INERTIA,
    ADD_MASS,
    REDUCE_COLUMNS,
    REDUCE_ROWS,
    ADD_TO_BAND,
    ADD_TO_SPARSE,
    ADD_CURVATURE,
    ROTATE_FRAME,
    ROTATE,
    COPY,
    CLEAR,
    STRAINS,
    FORCES,
    RATES,
    HESSIAN,
    LAW,
    LOAD_FORCES,
    PLACE_NODES,
    ADD_ELEMENTS,
    ADD_LOADS,
    FINISH_NODES,
    REDUCE,
    NODE_RATES,
    COMBINE,
    STORE,
    ADD_SCALED,
    FORM_MATRICES,
    ADD_MATRICES,
    RATE_NODES,
    VISCOUS,
    RELEASE,
) = range(38)
PLACE_KIND = 38  # place, convect and curve of each kind of node with a rotation
ROUTINE_COUNT = 47

# ------------------------------------------------------------------ the unknown coordinates and the solution for them
UNKNOWN = 0
FREE_DOFS = 1  # address (unknown,)
HALF = 2
ROLLERS = 3
ROLLER_FIRST = 4  # address (rollers,): number of the x of each among the unknowns
ROLLER_NORMAL = 5  # address (rollers, 2)
ROWS = 6  # address (unknown, 2 half + 1)
RIGHT = 7  # address (unknown,)
STEP = 8  # address (n,), for motions (n + 2,): with the last two rates of convergence
SCALE = 9  # address (n,)
LIMITS = 10  # see `newton_record`, for motions `motion_record`
FOUND = 11  # see `newton_record`
PRESCRIBED_STEP = 12
PRESCRIBED_FORCE = 13
PRESCRIBED = 14
PRESCRIBED_DOFS = 15
STATE = 16  # address (4, n): p, p', p'' and the auxiliary acceleration
BEFORE = 17
DIFFERENCES = 18  # see `predictor.difference_rows`
INVERSE_SCALE = 19  # address (padded(n),)
RULE = 20  # see `motion_record`
STATISTICS = 21  # see `motion_record`
RUNS_OF_PAIRS = 22  # of vectors that rotate with their section
PAIR_TABLE = 23  # (runs, pair fields): see `rotating_vectors.runs_of`
KEPT = 24  # (2, node stride)
ROTATIONS = 25  # (2, node stride)
STEPS = 26
PRESCRIBED_VALUES = 27  # (steps, 3, prescribed)
BODIES = 28  # (steps or 1, beams, 4)
BODY_STRIDE = 29  # from step to step, 0 if nothing varies
LOAD_VALUES = 30  # address of addresses, for each group (steps or 1, loads, 3)
LOADS_VARY = 31
SAVED = 32  # (rows, 3, n)
FIRST_STEP = 33
EVERY = 34
ROTATION_COUNT = 35
ROTATION_TABLE = 36  # (counted, 2)
ROTATED_BY = 37
SAVED_ROTATIONS = 38
LINEAR = 39  # address (n,)
NATURALS = 40  # address of addresses, for each group (steps or 1, elements, points, measures), 0 if there are none
NATURALS_VARY = 41
CHANGE = 42  # address (padded(n),): corrections, zero for prescribed coordinates
FIRST_FREE = 43  # number of the first unknown coordinate if all have consecutive numbers, else -1
PRESCRIBED_NOW = 44  # address (3, prescribed): in this step
ROTATIONS_WANTED = 45  # whether the stage computes how far sections have rotated since the last tangent
REACH = 46  # address (2, unknown) of 32 bits: see `band.elimination`, downwards and backwards
NODE_STRIDE = 47
NOW = 48  # number of the step that is taken, of those of this call
# a border of the band: unknowns that are coupled beyond it, and multipliers
EDGE = 49  # number t of those unknowns
EDGE_NUMBERS = 50  # address (t,)
CONDITIONS = 51  # number k of multipliers, which follow the unknowns of the band
MULTIPLIERS = 52  # address (k,): their coordinates
BORDER = 53  # address (t + k, t + k)
EDGE_COLUMNS = 54  # address (t, unknown): solutions of the band for the unit vectors of the edge
EDGE_FACTORS = 55  # address (t + k, t + k + 1): factors of the coupled system, each row with its pivot row
SOLVER_FIELDS = 56

# ------------------------------------------------------------------ runs of vectors that rotate with their section
PAIR_X, PAIR_Y = range(2)  # equation numbers of the first
PAIR_NODE = 2  # of the first, and one more for each of the next
PAIR_STEP = 3  # from one equation number to the next
PAIR_COUNT = 4
PAIR_FIELDS = 5

(
    BALANCE,
    FACTOR,
    SOLVE_UPPER,
    FACTOR_BOTH,  # from both ends, see `bidirectional_lu`
    SOLVE_BOTH,
    PREDICT_RESULTANTS,
    SMALLEST_JACOBIAN,
    CONSTRAIN_NORMALS,
    ROTATE_IN,
    ROTATE_BACK,
    TAKE_STEP,
    KEEP_DIRECTIONS,
    ROTATIONS_SINCE,
    ROTATE_PAIRS,
    COUNT_ROTATIONS,
    # stages of a time step, see `motion_stages`
    PREDICT,
    ASSEMBLE,
    FACTORISE,
    SOLVE,
    CORRECT,
    COMPLETE,
    # of a band with a border, see `bordered_band`
    FACTOR_BORDERED,
    SOLVE_BORDERED,
) = range(23)
SOLVER_ROUTINES = 23
