// A test: the reader drives the robot, and the page says whether it is right.
import type { JSX } from 'preact';
import { useState } from 'preact/hooks';
import { Button } from '../shared/play/button';
import { WorldName } from '../shared/play/board_pane';
import { Compare } from '../shared/play/compare';
import { RunsView } from '../shared/play/runs';
import { Mark } from '../shared/play/mark';
import { t } from '../shared/texts';
import { choiceText } from './choice';
import { partingOf, playBoard, upperFirst, usePrinting, type Context } from './context';
import { Sentences, textsOf, Whole } from './demonstration';
import type { Test } from './document';
import { askingText, Guessing, type Guess } from './guess';
import { OutcomesView } from './outcomes';

export function TestView({ test, title, name, ...context }: Context & { test: Test; title: string; name: string }): JSX.Element {
  const [guess, setGuess] = useState<Guess | null>(null);
  const isPrinting = usePrinting();
  const done = (made: Guess): void => {
    setGuess(made);
    context.tell(name, { shown: test, mine: made.mine, isRight: made.verdict?.isRight ?? false });
  };
  return (
    <article class="test card">
      <h4>{title}</h4>
      {!guess && (
        <p class="question">{askingText(context, test, t(test.map ? 'predict.question' : 'predict.question_plain'))}</p>
      )}
      <WorldName board={playBoard(context.domain, test)} />
      {isPrinting ? (
        <Whole {...context} board={{ ...test, frames: test.frames.slice(0, 1), runs: null }} />
      ) : guess ? (
        <Answered {...context} test={test} guess={guess} onAgain={() => setGuess(null)} />
      ) : (
        <Guessing {...context} shown={test} submit={t('predict.submit')} skip="Show the answer" onGuess={done} />
      )}
    </article>
  );
}

function Answered({ test, guess, onAgain, ...context }: Context & { test: Test; guess: Guess; onAgain: () => void }): JSX.Element {
  const { domain, legend } = context;
  const { mine, verdict } = guess;
  const isRight = verdict?.isRight ?? false;
  const at = mine && !isRight ? partingOf(test, mine) : null;
  const word = !mine ? 'none' : isRight ? 'right' : 'wrong';
  const why = verdict?.counts && !isRight ? choiceText(context.lesson, test.counts, verdict.counts) : '';
  const reason = (
    <>
      <div class={`verdict ${word}`} role="status">
        <Mark verdict={word} />
        <p>{t(`feedback.title.${word}`)}</p>
      </div>
      <div class="reasons">
        {isRight && mine && partingOf(test, mine) !== null && <p>{t('feedback.right_other')}</p>}
        {why !== '' && <p class="cost">{upperFirst(why)}.</p>}
        {textsOf(test.covers).length > 0 && (!isRight || test.is_shortest_wrong) && (
          <>
            <p>{isRight ? t('feedback.showed') : 'What the robot has shown:'}</p>
            <Sentences sentences={test.covers} />
          </>
        )}
      </div>
    </>
  );
  const again = (
    <div class="submit">
      <Button onClick={onAgain}>Try again</Button>
    </div>
  );
  if (test.runs) {
    return (
      <RunsView
        board={playBoard(domain, test)}
        legend={legend}
        shown={test.runs}
        isOpen
        reason={reason}
        below={<OutcomesView {...context} shown={test} mine={mine} other={isRight ? null : mine} at={at} />}
      >
        {again}
      </RunsView>
    );
  }
  return (
    <Compare
      board={playBoard(domain, test)}
      legend={legend}
      robot={test}
      other={isRight ? null : mine}
      otherName={t('ledger.you')}
      otherLine={t('feedback.mine')}
      at={at}
      reason={reason}
    >
      {again}
    </Compare>
  );
}
