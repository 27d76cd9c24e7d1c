bagnold_hot(dem fast/engine.cpp fast/exchange.cpp fast/history.cpp fast/ledger.cpp fast/ledger_pass.cpp fast/lists.cpp
            fast/observe.cpp fast/outer_list.cpp fast/rebuild.cpp fast/walls.cpp)
# The kernel lays three independent batches of pairs before the scheduler.
bagnold_abreast(dem fast/engine.cpp fast/ledger_pass.cpp fast/lists.cpp)
