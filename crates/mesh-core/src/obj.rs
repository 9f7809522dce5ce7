//! OBJ (to come)
