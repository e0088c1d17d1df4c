// What Python and the evolution page say to one another: written by `python -m app.protocol`.

/** @typedef {"IDLE" | "RUNNING" | "PAUSED" | "STOPPED" | "FINISHED" | "FAILED"} PhaseName */
/** @typedef {"whole" | "number" | "choice" | "switch"} FieldKind */
/** @typedef {{name: string, mean: number}} ReferenceLevel What a preset collects in the scenario of the run. */
/** @typedef {{text: string, english: string}} ReadRule A rule in the rule language and as a sentence. */

/**
 * All parameters that a run has, and the presets that fill them.
 * @typedef {object} FormMessage
 * @property {"form"} type
 * @property {string[]} presets
 * @property {number} most_compared
 * @property {SettingField[]} fields
 */

/**
 * The next run, as it was typed.
 * @typedef {object} PlanMessage
 * @property {"plan"} type
 * @property {string} preset
 * @property {Object<string, boolean | number | string>} values
 * @property {string[]} changed Fields that differ from the preset.
 * @property {string[]} idle Fields that have no effect beside the others.
 * @property {Object<string, string>} findings What is wrong, by field.
 * @property {boolean | number | string} seed
 * @property {boolean} from_table
 * @property {string} scenario
 * @property {string} table Name of the rules in the table.
 * @property {TableRule[]} rules
 * @property {boolean} moved The frozen rules are not the first ones.
 */

/**
 * What the evolution does now, and which run is looked at.
 * @typedef {object} EvolutionMessage
 * @property {"status"} type
 * @property {PhaseName} phase
 * @property {boolean} active
 * @property {string} error
 * @property {?string} run The present or last one.
 * @property {string[]} remarks What there is to know of the present run.
 * @property {boolean} resumable The run looked at can go on.
 * @property {number} done
 * @property {number} generations
 * @property {?string} shown The run looked at.
 * @property {string} problem Why it cannot be looked at.
 * @property {?AboutRun} about
 * @property {Object<string, number>} settings What can be steered; nothing unless a run is open.
 * @property {string[]} idle
 */

/**
 * The curves of the run looked at, the references, and what people did to it.
 * @typedef {object} CurvesMessage
 * @property {"curves"} type
 * @property {?string} run
 * @property {string} label What the curves are of: the objective, or what it is less than nothing.
 * @property {boolean} reevaluated Its best is evaluated again and again, so that its curve can fall.
 * @property {number[]} generation
 * @property {number[]} best_so_far
 * @property {number[]} best
 * @property {number[]} mean
 * @property {ReferenceLevel[]} references
 * @property {CurveMark[]} marks
 */

/**
 * The runs that are compared.
 * @typedef {object} ComparedRunsMessage
 * @property {"compared"} type
 * @property {OtherCurve[]} runs
 */

/**
 * The individuals of the last generation, the best first, and how they differ.
 * @typedef {object} PopulationMessage
 * @property {"population"} type
 * @property {number} generation
 * @property {number} size
 * @property {number} invalid
 * @property {number} behaviours
 * @property {number} diversity
 * @property {[number, number, string][]} coloured Common behaviours: number, how many have it, colour.
 * @property {Histogram} fitness
 * @property {Histogram} codons
 * @property {IndividualRow[]} members
 */

/**
 * Whom the best descends from: all of them, and the line of first parents, newest first.
 * @typedef {object} AncestorsMessage
 * @property {"ancestors"} type
 * @property {AncestorRow[]} all
 * @property {DescentRow[]} line
 */

/**
 * All runs that are kept.
 * @typedef {object} RunsMessage
 * @property {"runs"} type
 * @property {KeptRun[]} runs
 */

/**
 * The individual looked at and its rules.
 * @typedef {object} ChosenMessage
 * @property {"chosen"} type
 * @property {?ChosenIndividual} individual
 * @property {ReadRule[]} rules
 */

/**
 * A parameter of a run.
 * @typedef {object} SettingField
 * @property {string} name
 * @property {FieldKind} kind
 * @property {string[]} choices
 * @property {string} help
 * @property {boolean} steerable
 */

/**
 * A rule of the table, and whether evolution must not change it.
 * @typedef {object} TableRule
 * @property {string} text
 * @property {boolean} frozen
 * @property {boolean} enabled
 */

/**
 * What the run looked at is.
 * @typedef {object} AboutRun
 * @property {string} scenario
 * @property {NearestPreset} preset
 * @property {number} seed
 * @property {number} frozen How many rules.
 * @property {number} generations
 * @property {number} done
 * @property {boolean} finished
 * @property {?string} version Of the GESwarm that began it, if that is another one.
 * @property {?number} best
 * @property {string} fall Where the best so far is less than it was: a word for it.
 * @property {?number} mean
 */

/**
 * What a person did to a run.
 * @typedef {object} CurveMark
 * @property {number} generation The first one that it acted on.
 * @property {string} text
 * @property {?number} fitness Of the rules that entered; null if it was something else.
 */

/**
 * The best so far of a run that is compared.
 * @typedef {object} OtherCurve
 * @property {string} name
 * @property {number} colour
 * @property {boolean} reevaluated As in CurvesMessage.
 * @property {number[]} generation
 * @property {number[]} best_so_far
 */

/**
 * How many values lie in each of equally wide bins, and the mean of all.
 * @typedef {object} Histogram
 * @property {number} low
 * @property {number} high
 * @property {number} mean
 * @property {number[]} counts
 */

/**
 * An individual of the last generation.
 * In this order: generation, key, fitness, evaluations, codons, rules, behaviour.
 * @typedef {[number, number, number, number, number, ?number, ?number]} IndividualRow
 */

/**
 * Somebody from whom the best descends; births of the parents are generation and key.
 * In this order: generation, key, fitness, parents.
 * @typedef {[number, number, number, [number, number][]]} AncestorRow
 */

/**
 * Somebody in the line of first parents, and how it was bred.
 * In this order: generation, key, fitness, bred, codons.
 * @typedef {[number, number, number, string, number]} DescentRow
 */

/**
 * A run that is kept.
 * @typedef {object} KeptRun
 * @property {string} name
 * @property {?number} colour Of its curve and its box, if it is compared.
 * @property {boolean} elsewhere It is under way in another process.
 * @property {string} problem
 * @property {string} scenario
 * @property {?NearestPreset} preset
 * @property {?number} seed
 * @property {number} done
 * @property {?number} generations
 * @property {?number} best
 * @property {string} fall As in AboutRun.
 * @property {PhaseName} phase
 * @property {number} written Seconds since 1970.
 */

/**
 * The individual looked at.
 * @typedef {object} ChosenIndividual
 * @property {string} run
 * @property {number} generation
 * @property {number} key
 * @property {number} fitness
 */

/**
 * The preset that settings are closest to, and where they differ.
 * @typedef {object} NearestPreset
 * @property {string} name
 * @property {string[]} changed
 */

/** Messages to Python. */
export const request = {
  /** Fill the plan of the next run. @param {string} name */
  preset: (name) => ({ type: "preset", name }),
  /**
   * A setting of the next run, its `seed` or `from_table` was typed.
   *
   * @param {string} name
   * @param {boolean | number | string} value
   */
  plan: (name, value) => ({ type: "plan", name, value }),
  /** Evolution must not change a rule of the table, or may again. @param {number} rule @param {boolean} on */
  freeze: (rule, on) => ({ type: "freeze", rule, on }),
  /** Begin the next run. @param {boolean} [instead] Also if that stops the one under way. */
  start: (instead) => ({ type: "start", instead }),
  /** Pause the run under way. */
  pause: () => ({ type: "pause" }),
  /** Go on with the paused run. */
  goOn: () => ({ type: "go_on" }),
  /** Stop the run under way. */
  stop: () => ({ type: "stop" }),
  /** Change a setting of the run under way. @param {string} name @param {number} value */
  steer: (name, value) => ({ type: "steer", name, value }),
  /** Put the rules of the table into the population. */
  inject: () => ({ type: "inject" }),
  /** Put the best rules into the table. */
  loadBest: () => ({ type: "load_best" }),
  /** Look at an individual. @param {number} generation @param {number} key */
  choose: (generation, key) => ({ type: "choose", generation, key }),
  /** Look at no individual. */
  forget: () => ({ type: "forget" }),
  /** Put the rules of the individual looked at into the table. */
  load: () => ({ type: "load" }),
  /** Run the individual looked at in the arena, beside the table. */
  compareWith: () => ({ type: "compare_with" }),
  /** Look at a run. @param {string} name */
  open: (name) => ({ type: "open", name }),
  /** Lay the curve of a run over the others, or no longer. @param {string} name @param {boolean} on */
  compare: (name, on) => ({ type: "compare", name, on }),
  /**
   * Go on with a run.
   *
   * @param {string} name
   * @param {?number} [generations] How many it is to have; null for as many as it was to have.
   * @param {boolean} [instead] As in StartRun.
   */
  resume: (name, generations, instead) => ({ type: "resume", name, generations, instead }),
  /** Delete a run. @param {string} name */
  delete: (name) => ({ type: "delete", name }),
};
