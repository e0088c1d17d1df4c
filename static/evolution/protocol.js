/**
 * The messages between the page and Python, as types. Rules, individuals and colours count from 0, behaviours from 1.
 *
 * @typedef {"IDLE" | "RUNNING" | "PAUSED" | "STOPPED" | "FINISHED" | "FAILED"} Phase
 * @typedef {{name: string, changed: string[]}} Preset The nearest one, and where settings differ.
 *
 * @typedef {object} Field
 * @property {string} name
 * @property {"whole" | "number" | "choice" | "switch"} kind
 * @property {string[]} choices
 * @property {string} help
 * @property {boolean} steerable
 *
 * @typedef {object} FormMessage
 * @property {"form"} type
 * @property {string[]} presets
 * @property {number} most_compared
 * @property {Field[]} fields
 *
 * @typedef {object} PlanMessage The next run, as it was typed.
 * @property {"plan"} type
 * @property {string} preset
 * @property {Object<string, number | string | boolean>} values
 * @property {string[]} changed Fields that differ from the preset.
 * @property {string[]} idle Fields that have no effect beside the others.
 * @property {Object<string, string>} findings What is wrong, by field.
 * @property {number | string} seed
 * @property {boolean} from_table
 * @property {string} scenario
 * @property {string} table Name of the rules in the table.
 * @property {{text: string, frozen: boolean, enabled: boolean}[]} rules
 * @property {boolean} moved The frozen rules are not the first ones.
 *
 * @typedef {object} About
 * @property {string} scenario
 * @property {Preset} preset
 * @property {number} seed
 * @property {number} frozen How many rules.
 * @property {number} generations
 * @property {number} done
 * @property {boolean} finished
 * @property {?string} version Of the GESwarm that began it, if that is another one.
 * @property {?number} best
 * @property {string} fall Where the best so far is less than it was: a word for it.
 * @property {?number} mean
 *
 * @typedef {object} StatusMessage
 * @property {"status"} type
 * @property {Phase} phase
 * @property {boolean} active
 * @property {string} error
 * @property {?string} run The present or last one.
 * @property {string[]} remarks What there is to know of the present run.
 * @property {boolean} resumable The run looked at can go on.
 * @property {number} done
 * @property {number} generations
 * @property {?string} shown The run looked at.
 * @property {string} problem Why it cannot be looked at.
 * @property {?About} about
 * @property {Object<string, number>} settings What can be steered; nothing unless a run is open.
 * @property {string[]} idle
 *
 * @typedef {object} CurvesMessage
 * @property {"curves"} type
 * @property {?string} run
 * @property {boolean} reevaluated Its best is evaluated again and again, so that its curve can fall.
 * @property {number[]} generation
 * @property {number[]} best_so_far
 * @property {number[]} best
 * @property {number[]} mean
 * @property {{name: string, mean: number}[]} references
 * @property {{generation: number, text: string, fitness: ?number}[]} marks
 *
 * @typedef {object} OtherCurve
 * @property {string} name
 * @property {number} colour
 * @property {boolean} reevaluated
 * @property {number[]} generation
 * @property {number[]} best_so_far
 * @typedef {{type: "compared", runs: OtherCurve[]}} ComparedMessage
 *
 * @typedef {{low: number, high: number, mean: number, counts: number[]}} Histogram
 * @typedef {[number, number, number, number, number, ?number, ?number]} Member
 *   Generation, key, fitness, evaluations, codons, rules, number of the behaviour.
 *
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
 * @property {Member[]} members The best first.
 *
 * @typedef {[number, number, number, [number, number][]]} Ancestor
 *   Generation, key, fitness, births of the parents.
 * @typedef {[number, number, number, string, number]} Step
 *   Generation, key, fitness, how it was bred, codons.
 * @typedef {{type: "ancestors", all: Ancestor[], line: Step[]}} AncestorsMessage
 *
 * @typedef {object} Run
 * @property {string} name
 * @property {string} problem
 * @property {string} scenario
 * @property {?Preset} preset
 * @property {?number} seed
 * @property {number} done
 * @property {?number} generations
 * @property {?number} best
 * @property {Phase} phase
 * @property {string} fall As in `About`.
 * @property {?number} colour Of its curve and its box, if it is compared.
 * @property {boolean} elsewhere It is under way in another process.
 * @property {number} written Seconds since 1970.
 *
 * @typedef {{type: "runs", runs: Run[]}} RunsMessage
 *
 * @typedef {object} ChosenMessage
 * @property {"chosen"} type
 * @property {?{run: string, generation: number, key: number, fitness: number}} individual
 * @property {{text: string, english: string}[]} rules
 *
 * @typedef {{type: "notice", level: "error" | "info", text: string}} NoticeMessage
 */

export {};
